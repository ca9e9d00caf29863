//! Sheet metal forming with contact: the NAFEMS contact benchmark 3 (code_aster test SSNP155).

pub mod output;
