#!/usr/bin/env bash
# Makes the tables of docs/contact.md: where contact is looked for, and how stiff it is.
#   scripts/contact_table.sh [FOLDER]          results go to FOLDER (default results-contact)
# One rank, one run after the other: about 3 minutes of processor time, and some 2 with FINE=1 for the 340 x 10 mesh. A run
# that is already in FOLDER is not done again. The program is target/release/ssnp155, or $SSNP155.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-results-contact}
source scripts/environment.sh
program=${SSNP155:-${CARGO_TARGET_DIR:-target}/release/ssnp155}
[ -n "${SSNP155:-}" ] || cargo build --release --locked

# A row at least every 0.1 mm where the noise is measured.
dense=$(awk 'BEGIN { for (i = 0; i <= 100; i++) printf ",%g", 14.5 + 0.1 * i }')

run() {
    local name=$1
    shift
    [ -e "$folder/$name/summary.json" ] && return
    echo "run: $name: $*" >&2
    # A run whose verdicts fail is a result, too.
    "$program" -options_file inputs/band.opts -output_every 0 -output_dir "$folder/$name" "$@" >"$folder/$name.log" 2>&1 || true
}
noisy() {
    local name=$1
    shift
    run "$name" -report_strokes "1,2,5,8,10,12$dense,26,28" "$@"
}
mkdir -p "$folder"

location=()
for mesh in "85 3" "170 5" ${FINE:+"340 10"}; do
    read -r nx ny <<<"$mesh"
    kinds=(nodes 2 3 6 12 closest)
    [ "$nx" != 340 ] || kinds=(nodes 6 closest)
    for kind in "${kinds[@]}"; do
        case $kind in
        [0-9]*) options=(-contact_points_per_edge "$kind") ;;
        *) options=(-contact_location "$kind") ;;
        esac
        noisy "$nx-$kind" -sheet_nx "$nx" -sheet_ny "$ny" "${options[@]}"
        location+=("$folder/$nx-$kind")
    done
done

friction=()
for mesh in "85 3" "170 5"; do
    read -r nx ny <<<"$mesh"
    for kind in points closest; do
        noisy "$nx-$kind-friction" -sheet_nx "$nx" -sheet_ny "$ny" -contact_location $kind -friction_coefficient 0.1342
        friction+=("$folder/$nx-$kind-friction")
    done
done

# Stiffness of contact and friction.
stiffer=(-contact_compliance 5e-6)
softer=(-contact_compliance 5e-4 -penetration_limit 5e-2)
compliance=()
for mesh in "85 3" "170 5"; do
    read -r nx ny <<<"$mesh"
    for kind in points closest; do
        options=(-sheet_nx "$nx" -sheet_ny "$ny" -contact_location $kind)
        run "$nx-$kind-default" "${options[@]}"
        run "$nx-$kind-stiffer" "${options[@]}" "${stiffer[@]}"
        run "$nx-$kind-softer" "${options[@]}" "${softer[@]}"
        compliance+=("$folder/$nx-$kind-default" "$folder/$nx-$kind-stiffer" "$folder/$nx-$kind-softer")
    done
done
slip=()
for mesh in "85 3" "170 5"; do
    read -r nx ny <<<"$mesh"
    options=(-sheet_nx "$nx" -sheet_ny "$ny" -friction_coefficient 0.1342)
    run "$nx-slip-default" "${options[@]}"
    run "$nx-slip-stiffer" "${options[@]}" -friction_compliance 5e-5
    run "$nx-slip-softer" "${options[@]}" -friction_compliance 5e-3
    slip+=("$folder/$nx-slip-default" "$folder/$nx-slip-stiffer" "$folder/$nx-slip-softer")
done

# In code_aster's manner: nodes and equal steps.
run discrete -options_file inputs/ssnp155-discrete.opts -output_every 0 -output_dir "$folder/discrete"

echo
scripts/contact_noise.py --header "${location[@]}"
echo
scripts/contact_noise.py --header "${friction[@]}"
echo
scripts/contact_change.py "${compliance[@]}"
echo
scripts/contact_change.py "${slip[@]}"
echo
scripts/contact_change.py --curve inputs/reference/code_aster-15.2-frictionless.csv "$folder/discrete"
