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
# The check is the same for every suite, so the smallest serves: its passes are too short to be called slow by the clock.
suite=(--no-config bench --suite smoke)

"$scratch/as-it-is" "${suite[@]}" --record "$scratch/baseline.json" >"$scratch/table" 2>"$scratch/said" ||
    fail "no baseline: $(tail -1 "$scratch/said")"
instructions=$(grep -c 'instructions$' "$scratch/table" || true)

# check NAME CODE [FLAG]: runs the suite against the baseline; what is found goes to NAME.found.
check() {
    local name=$1 expected=$2 code=0
    shift 2
    "$scratch/$name" "${suite[@]}" --check "$scratch/baseline.json" "$@" >"$scratch/$name.table" 2>"$scratch/$name.said" || code=$?
    grep -E '^  ' "$scratch/$name.said" >"$scratch/$name.found" || true
    echo "--- $name: exit code $code"
    cat "$scratch/$name.found"
    [ "$code" = "$expected" ] || fail "$name ended with $code instead of $expected: $(tail -1 "$scratch/$name.said")"
}

check as-it-is 0

check changed-count 1 --no-instructions
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
