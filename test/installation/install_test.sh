#!/bin/sh
# install_test.sh CMAKE BUILD_FOLDER: what `cmake --install` puts where, and that landfix runs from there.
set -eu
cmake=$1
build=$2
prefix=$(mktemp -d)
trap 'rm -rf "$prefix"' EXIT
"$cmake" --install "$build" --prefix "$prefix" >/dev/null

expected='bin/landfix
bin/landfixd
etc/landfix/landfix.toml
lib/systemd/system/landfixd.service
share/doc/landfix/README.md
share/doc/landfix/copyright
share/landfix/landfix.dbc'
found=$(cd "$prefix" && find . -type f | sed 's|^\./||' | LC_ALL=C sort)
[ "$found" = "$expected" ] || {
  printf 'installed:\n%s\nexpected:\n%s\n' "$found" "$expected"
  exit 1
}
"$prefix/bin/landfix" --version
"$prefix/bin/landfix" doctor --config "$prefix/etc/landfix/landfix.toml" >/dev/null
