#!/usr/bin/env bash
# The jobs of a list as a Slurm array, each a task of its own on whatever node is free:
#
#   certilux batch jobs.toml --out solved --list-names > names.txt
#   sbatch --array=1-"$(wc -l < names.txt)" docs/batch/slurm-array.sh jobs.toml solved names.txt
#
# A task that was preempted or ran out of time is put back in the queue, and goes on from its checkpoint. When all
# have ended, `certilux batch jobs.toml --out solved --resume` skips what is done and writes solved/batch.json.
#
#SBATCH --job-name=certilux
#SBATCH --cpus-per-task=8
#SBATCH --mem=16G
#SBATCH --time=04:00:00
#SBATCH --requeue
#SBATCH --signal=TERM@60
#SBATCH --output=slurm-%A_%a.out
set -euo pipefail
list=$1 out=$2 names=$3
name=$(sed -n "${SLURM_ARRAY_TASK_ID}p" "$names")
# exec, so that the signal reaches certilux itself: it stops cleanly, its last checkpoint in place.
exec certilux batch "$list" --out "$out" --resume --only "$name" \
    --threads "${SLURM_CPUS_PER_TASK:-1}" --jobs 1 ${SLURM_MEM_PER_NODE:+--max-memory "${SLURM_MEM_PER_NODE}M"}
