#!/bin/sh
# quoted_includes_test.sh ROOT
# Passes if each quoted include is written from the root, so that the include rule sees it: no "../", and
# nothing found only because it lies beside the includer.
set -u
cd "$1" || exit 1

status=0
if grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"' --include='*.[ch]pp' drivers ndt platform tools |
  grep -vE 'include[[:space:]]*"(drivers|ndt|platform|tools)/'; then
  echo 'These start at no folder of the house.'
  status=1
fi
if grep -rnE '^[[:space:]]*#[[:space:]]*include[[:space:]]*"([^"]*/)?\.\./' --include='*.[ch]pp' \
  drivers ndt platform tools test; then
  echo 'These climb out of their folder.'
  status=1
fi
exit $status
