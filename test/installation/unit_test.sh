#!/bin/sh
# unit_test.sh UNIT: systemd finds nothing wrong with the unit, it is closed to all that it does not need, and it has
# none of the lines that would quietly take real time away.
set -eu
unit=$1

if traps=$(grep -nE '^(RestrictRealtime=(yes|true|1|on)|SystemCallFilter=~.*@(resources|memlock)|PrivateUsers=(yes|true|1|on)|Memory(Max|High)=|CPUQuota=)' "$unit"); then
  printf '%s takes real time away:\n%s\n' "$unit" "$traps"
  exit 1
fi

command -v systemd-analyze >/dev/null || {
  echo 'skipped: no systemd-analyze here'
  exit 77
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# It has to name a program that is there, and the program is not installed.
sed 's|^ExecStart=[^ ]*|ExecStart=/bin/true|; s|^Documentation=file:.*||' "$unit" >"$folder/landfixd.service"
said=$(systemd-analyze verify --man=no "$folder/landfixd.service" 2>&1) || {
  printf '%s\n' "$said"
  exit 1
}
[ -z "$said" ] || {
  printf 'systemd-analyze verify says:\n%s\n' "$said"
  exit 1
}
systemd-analyze security --no-pager --offline=yes --threshold=30 "$folder/landfixd.service"
