#!/usr/bin/env bash
# Runs one command of certa on many files, with GNU parallel; one that fails does not stop the others.
#
#   batch.sh OUT EXTENSION COMMAND [OPTION...] < LIST
#
# LIST names one input file per line. For each of them OUT gets a result (NAME.EXTENSION), a report (NAME.json) and what
# was printed (NAME.log); OUT/jobs.log is parallel's own account. Started again with the same OUT, it goes on where it
# was stopped; `RETRY=1 batch.sh ...` also repeats those that failed. At the end OUT/table.csv has a row per file.
#   JOBS=N     files at the same time (default: as many as there are processors), each on one thread
#   CERTA=...  the command (default: certa)
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

if [ "${1:-}" = --one ]; then  # what parallel calls: --one OUT EXTENSION FILE COMMAND [OPTION...]
  out=$2 extension=$3 file=$4 command=$5
  shift 5
  # a/b.off and a_b.off stay apart, every name can be undone, and none is hidden (../b.off).
  name=$(printf %s "$file" | sed 's/%/%25/g; s:/:%2F:g; s:^\.:%2E:')
  status=0
  "${CERTA:-certa}" "$command" "$file" "$@" -o "$out/$name.$extension" --json "$out/$name.json" --threads 1 --quiet \
    >"$out/$name.log" 2>&1 || status=$?
  printf '%s\t%s\t%s\n' "$status" "$file" "$name" >"$out/$name.status"
  exit "$status"
fi

if [ $# -lt 3 ]; then
  sed -n '2,11s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2
  exit 2
fi
out=$1 extension=$2
shift 2
command -v "${CERTA:-certa}" >/dev/null || { echo "batch: there is no command ${CERTA:-certa}; CERTA=... names it" >&2; exit 2; }
mkdir -p "$out"
resume=--resume
[ "${RETRY:-0}" = 1 ] && resume=--resume-failed
parallel --will-cite --jobs "${JOBS:-100%}" --joblog "$out/jobs.log" "$resume" --quote \
  "${BASH_SOURCE[0]}" --one "$out" "$extension" {} "$@" || true
python3 "$here/merge.py" "$out"
# Those of an earlier start count too.
failed=$(find "$out" -name '*.status' -exec awk -F '\t' '$1 != 0' {} + | wc -l)
[ "$failed" -eq 0 ] || echo "batch: some files failed; $out/table.csv says which" >&2
exit $((failed > 0))
