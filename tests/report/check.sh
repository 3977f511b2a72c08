#!/usr/bin/env bash
# Makes a report of a small solve, a comparison and a sweep, and opens it in headless Chromium.
#
#     tests/report/check.sh target/release/certilux
#
# Everything, Chromium and the screenshots included, is left in target/report-check.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$(realpath "$1")
scratch=$here/../../target/report-check
mkdir -p "$scratch"
cd "$scratch"
cp "$here/package.json" "$here/check.mjs" .
if ! cmp -s package.json installed; then
    npm install --silent --no-audit --no-fund
    cp package.json installed
fi
quick=(--quiet --no-config)
"$program" "${quick[@]}" solve builtin:two-rooms --out solved --technique blockers --epsilon 1e-4
mkdir -p compared
"$program" "${quick[@]}" compare builtin:cornell builtin:a --repeat 1 --passes 2 --epsilon 1e-4 --json compared/compare.json
"$program" "${quick[@]}" sweep builtin:cornell --out swept --quick --reference-seconds 3 --reference-error 0.02
"$program" "${quick[@]}" report solved compared swept --out report.html
node check.mjs report.html
