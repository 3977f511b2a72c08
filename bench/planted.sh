#!/usr/bin/env bash
# Plants a slow kernel and a changed count in the program and shows that `certilux bench --check` catches each, and
# nothing else. The slow-down is about 5 %, which instructions tell and the clock does not: needs valgrind.
set -euo pipefail
cd "$(dirname "$0")/.."

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() {
    echo "planted: $*" >&2
    exit 1
}

cargo build --release --example planted --features plant-regressions
for name in as-it-is slow-kernel changed-count; do
    cp target/release/examples/planted "$scratch/$name"
done

"$scratch/as-it-is" --no-config bench --suite ci --record "$scratch/baseline.json" >"$scratch/table" 2>"$scratch/said" ||
    fail "no baseline: $(tail -1 "$scratch/said")"
instructions=$(grep -c 'instructions$' "$scratch/table" || true)

# check NAME CODE: runs the suite against the baseline; what is found goes to NAME.found.
check() {
    local code=0
    "$scratch/$1" --no-config bench --suite ci --check "$scratch/baseline.json" >"$scratch/$1.table" 2>"$scratch/$1.said" || code=$?
    grep -E '^  ' "$scratch/$1.said" >"$scratch/$1.found" || true
    echo "--- $1: exit code $code"
    cat "$scratch/$1.found"
    [ "$code" = "$2" ] || fail "$1 ended with $code instead of $2: $(tail -1 "$scratch/$1.said")"
}

check as-it-is 0

check changed-count 1
grep -q ': rays was [0-9]*, is [0-9]*' "$scratch/changed-count.found" || fail 'the changed count was not found'
if grep -qv ': rays was' "$scratch/changed-count.found"; then fail 'more than the rays differs'; fi

if [ "$instructions" = 0 ]; then
    echo 'planted: the slow kernel was SKIPPED: valgrind is not installed'
    exit 0
fi
check slow-kernel 1
grep -q 'instructions of normal: .* (+[3-7]\.[0-9] %)' "$scratch/slow-kernel.found" || fail 'the slow kernel was not found'
if grep -qv 'instructions of' "$scratch/slow-kernel.found"; then fail 'more than the instructions differs'; fi
echo 'planted: both were caught'
