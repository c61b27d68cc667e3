#!/usr/bin/env bash
# The same on a cluster: one array task of Slurm takes every N-th line of the list.
#
#   sbatch --array=0-31 slurm.sh LIST OUT EXTENSION COMMAND [OPTION...]
#
# OUT must be on a file system that all nodes see. Submitted again, each task goes on where it was stopped. When the
# array has ended: merge.py OUT
#SBATCH --job-name=certa
#SBATCH --cpus-per-task=4
#SBATCH --mem=8G
#SBATCH --output=certa_%A_%a.txt
set -euo pipefail
if [ $# -lt 4 ]; then
  sed -n '2,7s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
list=$1 out=$2
shift 2
# Slurm runs a copy of this script: the others are beside the one that was submitted.
here=${CERTA_BATCH:-${SLURM_SUBMIT_DIR:-.}}
task=${SLURM_ARRAY_TASK_ID:?to be submitted with sbatch --array}
count=${SLURM_ARRAY_TASK_COUNT:?to be submitted with sbatch --array}
first=${SLURM_ARRAY_TASK_MIN:-0} step=${SLURM_ARRAY_TASK_STEP:-1}
awk -v n="$count" -v k=$(((task - first) / step)) 'NR % n == k' "$list" |
  JOBS=${SLURM_CPUS_PER_TASK:-1} "$here/batch.sh" "$out/task_$task" "$@"
