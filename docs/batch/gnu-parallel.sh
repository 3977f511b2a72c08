#!/usr/bin/env bash
# The jobs of a list through GNU parallel, here or on other machines (add --sshloginfile FILE and a shared folder):
#
#   docs/batch/gnu-parallel.sh jobs.toml solved 4
#
# runs four at a time, two threads each on eight processors. Killed and started again, it goes on where it was.
set -euo pipefail
list=$1 out=$2 jobs=${3:-2}
threads=$(($(nproc) / jobs))
mkdir -p "$out"
certilux batch "$list" --out "$out" --list-names \
    | parallel --jobs "$jobs" --halt never --joblog "$out/parallel.log" \
        certilux batch "$list" --out "$out" --resume --only {} --jobs 1 --threads "$((threads > 0 ? threads : 1))" --quiet \
    || true
# Skips all that is done, tries again what failed, and writes batch.json.
exec certilux batch "$list" --out "$out" --resume
