#!/usr/bin/env bash
# Time and peak memory of every stage over arrays of rooms. `bench/growth.sh DIR [SIZES [TECHNIQUE]]`; the whole set takes a quiet
# machine with 4 GiB: bench/growth.sh bench/runs/DATE-HOST/growth 1000,10000,100000,1000000
set -euo pipefail
cd "$(dirname "$0")/.."
out=${1:?a folder for growth.csv and growth.md}
sizes=${2:-1000,10000}
technique=${3:-blockers}
cargo build --release --example growth
target/release/examples/growth --out "$out" --polygons "$sizes" --technique "$technique"
cat "$out/growth.md"
