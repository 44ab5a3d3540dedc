#!/usr/bin/env bash
# Seconds of every suite, as rows of the table in tests/README.md, the longest first: wall and processor
# (user and system, with all processes that were started). Builds from nothing into a folder of its own,
# for want of a fresh machine; beside other programs the numbers mean little. Run from anywhere:
#   tests/timing.sh [TARGET_DIR]
set -euo pipefail
TIMEFORMAT='%R %U %S'

# Runs a command under a name and notes what it took.
timed() {
  local name=$1 times
  shift
  exec 3>&1 4>&2
  times=$({ time "$@" >&3 2>&4; } 2>&1)
  awk -v name="$name" '{ printf "| %s | %.0f | %.0f |\n", name, $1, $2 + $3 }' <<<"$times" >>"$ROWS"
}

# cargo calls this script for every suite, with the suite's program and its arguments
if [ -n "${ROWS:-}" ]; then
  name=$(basename "$1")
  timed "\`${name%-*}\`" "$@"
  exit
fi

cd "$(dirname "$0")/.."
export CARGO_TARGET_DIR=${1:-$(mktemp -d)}
ROWS=$(mktemp)
timed "building all of them" cargo test --workspace --no-run
export ROWS
cargo test --workspace --config "target.'cfg(all())'.runner = '$PWD/tests/timing.sh'"
sort -t '|' -k 3 -n -r "$ROWS"
