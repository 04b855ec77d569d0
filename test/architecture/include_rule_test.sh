#!/bin/sh
# include_rule_test.sh found|missing HEADER COMPILER -IDIRECTORY...
# Compiles the one line `#include "HEADER"` as a source of the target with these include directories would be;
# passes if that works (found), or fails because there is no such file (missing).
set -eu
expected=$1 header=$2 compiler=$3
shift 3

cd / # a quoted include also looks beside the including file
if complaint=$(printf '#include "%s"\n' "$header" | LC_ALL=C "$compiler" -std=c++20 -fsyntax-only "$@" -x c++ - 2>&1); then
  outcome=found
elif printf '%s' "$complaint" | grep -qE "$header'?:? (No such file|file not found)"; then
  outcome=missing
else
  outcome="neither found nor missing: $complaint"
fi
[ "$outcome" = "$expected" ] || {
  echo "#include \"$header\" is $outcome, but should be $expected; include directories: $*"
  exit 1
}
