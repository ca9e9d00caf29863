//! The page docs/history.md says what the columns of history.csv are; the columns that are promised stay.

use ssnp155::output::record::{COLUMNS, columns_markdown};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/history.md");

#[test]
fn the_page_of_columns_is_rendered_from_their_declaration() {
    let rendered = columns_markdown();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(PAGE, &rendered).expect("docs/history.md can be written");
    }
    let page = std::fs::read_to_string(PAGE).unwrap_or_default();
    assert!(
        page == rendered,
        "docs/history.md is out of date: run UPDATE_DOCS=1 cargo test --test output_history"
    );
}

/// Scripts of others read these by name and by place: new ones go behind them.
#[test]
fn the_columns_that_people_were_promised_come_first() {
    let promised = "t_ms,stroke_mm,force_N,dy_A_punch_mm,dy_A_sheet_mm,gap_A_mm,angle_deg,dt_ms,newton_iterations,\
                    active_points,max_penetration_mm,min_contact_force_N,kinetic_energy_mJ,strain_energy_mJ,\
                    plastic_dissipation_mJ,contact_energy_mJ,external_work_mJ,energy_error,die_force_N,inertia_N,\
                    balance_error,cone_violation,angle_fit_residual_mm,residual_norm_mm,refused_solves,\
                    max_complementarity_mJ";
    let names: Vec<&str> = COLUMNS.iter().map(|column| column.name).collect();
    assert!(names.join(",").starts_with(promised), "{names:?}");
}
