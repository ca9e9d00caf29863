#!/usr/bin/env bash
# Makes the tables of docs/contact.md: where contact is looked for, and how stiff it is.
#   scripts/contact_table.sh [FOLDER]          results go to FOLDER (default results-contact)
# One rank, one run after the other: about 20 minutes of processor time. A run that is already in FOLDER is not done again.
# FINE=1 also runs the 340 x 10 mesh.
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-results-contact}
source scripts/environment.sh
cargo build --release --locked

# A row at least every 0.1 mm where the noise is measured.
dense=$(awk 'BEGIN { for (i = 0; i <= 100; i++) printf ",%g", 14.5 + 0.1 * i }')

run() {
    local name=$1
    shift
    [ -e "$folder/$name/summary.json" ] && return
    # A run whose verdicts fail is a result, too.
    "${CARGO_TARGET_DIR:-target}/release/ssnp155" -options_file inputs/ssnp155.opts -report_strokes "1,2,5,8,10,12$dense,26,28" -output_every 0 \
        -output_dir "$folder/$name" "$@" || true
}

meshes=("85 3" "170 5")
[ -z "${FINE:-}" ] || meshes+=("340 10")
runs=()
for mesh in "${meshes[@]}"; do
    read -r nx ny <<<"$mesh"
    for points in 2 3 6 12; do
        runs+=("$folder/$nx-points-$points")
        run "$nx-points-$points" -sheet_nx "$nx" -sheet_ny "$ny" -contact_points_per_edge $points
    done
    for location in nodes closest; do
        runs+=("$folder/$nx-$location")
        run "$nx-$location" -sheet_nx "$nx" -sheet_ny "$ny" -contact_location $location
    done
done

# Stiffness of contact and friction, on the coarse mesh.
coarse=(-sheet_nx 85 -sheet_ny 3)
run 85-hard "${coarse[@]}" -contact_compliance 5e-6
run 85-soft "${coarse[@]}" -contact_compliance 5e-4 -penetration_limit 5e-2
run 85-friction "${coarse[@]}" -friction_coefficient 0.1342
run 85-friction-closest "${coarse[@]}" -friction_coefficient 0.1342 -contact_location closest
run 85-friction-hard "${coarse[@]}" -friction_coefficient 0.1342 -friction_compliance 5e-5
run 85-friction-soft "${coarse[@]}" -friction_coefficient 0.1342 -friction_compliance 5e-3

echo
scripts/contact_noise.py --header "${runs[@]}"
echo
scripts/contact_noise.py --header "$folder"/85-{points-6,hard,soft,friction,friction-closest,friction-hard,friction-soft}
