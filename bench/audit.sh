#!/usr/bin/env bash
# Audits the guarantees on every built-in scene: `bench/audit.sh DIR` leaves a JSON a run and audit.md, the table, in DIR
# (some minutes on one core). `bench/audit.sh DIR FILE.obj [FLAGS]` audits one scene more and makes the table anew. Ends with 1 if a
# contradiction stands. CERTILUX names a program that is already built.
set -euo pipefail
here=$(cd "$(dirname "$0")/.." && pwd)
out=${1:?a folder for the results}
shift
if [ -z "${CERTILUX:-}" ]; then
    (cd "$here" && cargo build --release)
    CERTILUX=$here/target/release/certilux
fi
CERTILUX=$(realpath "$CERTILUX")
mkdir -p "$out"
failed=0

# run NAME SCENE FLAGS...: a contradiction does not stop the others.
run() {
    local name=$1 code=0
    shift
    echo "$name" >&2
    "$CERTILUX" --no-config audit "$@" --threads 1 --quiet --json "$out/$name.json" >&2 || code=$?
    case $code in
    0) ;;
    1) failed=1 ;;
    *) exit "$code" ;;
    esac
}

if [ $# -gt 0 ]; then
    scene=$1
    shift
    name=$(basename "$scene" .obj)
    run "$name" "$scene" --stride 4 --claims 100000 "$@"
    run "$name-auto" "$scene" --claims 50000 "$@"
else
    # The paper's stride, at which most is claimed; large scenes at the epsilon of the paper's table.
    for scene in a b c e offices; do
        run "$scene" "builtin:$scene" --stride 4 --claims 50000 --passes 1 --epsilon 1e-4
    done
    small=$("$CERTILUX" generate --list | cut -d ' ' -f 1 | grep -vxE 'a|b|c|e|offices')
    for scene in $small; do
        run "$scene" "builtin:$scene" --stride 4 --claims 100000 --passes 2
    done
    # What a user gets who asks for nothing: boxes of air among it, which a fixed stride leaves out.
    for scene in a b c e offices; do
        run "$scene-auto" "builtin:$scene" --claims 50000 --passes 1 --epsilon 1e-4
    done
    for scene in cornell-spheres furnace-blocks furnace-partitions sealed; do
        run "$scene-auto" "builtin:$scene" --claims 50000 --passes 2
    done
    for scene in cornell corridor d f two-rooms; do
        run "$scene-blockers-auto" "builtin:$scene" --technique blockers --claims all --passes 2
    done
fi

python3 - "$out" <<'PYTHON'
import json, pathlib, sys

folder = pathlib.Path(sys.argv[1])
runs = [(path.stem, json.loads(path.read_text())) for path in sorted(folder.glob("*.json"))]
columns = ["claims_made", "occlusion_claims", "visibility_claims", "occluders_proved", "occluders_claimed", "occlusion_proofs",
           "visibility_proofs", "polygons_undecided", "rays", "contradictions_by_embree", "contradictions_standing"]


def row(name, polygons, run):
    made, hidden, seen, proved, claimed, proofs, shafts, undecided, rays, by_embree, stand = (run[c] for c in columns)
    return (f"| {name} | {polygons} | {made:,} | {hidden:,} | {seen:,} | {proved}/{claimed} | {proofs:,} | {shafts:,} | {undecided} "
            f"| {rays / 1e6:.2f} M | {by_embree:,} | {stand} |")


total = {c: sum(run[c] for _, run in runs) for c in columns}
heads = ["run", "polygons", "claims made", "audited: occluded", "audited: visible", "occluders proved", "occlusion proofs",
         "shafts by brute force", "undecided polygons", "rays", "contradictions by Embree", "that stand"]
lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
lines += [row(name, f"{run['polygons']:,}", run) for name, run in runs]
lines.append(row("**sum**", "", total))
table = "\n".join(lines) + "\n"
(folder / "audit.md").write_text(table)
print(table, end="")
PYTHON
exit $failed
