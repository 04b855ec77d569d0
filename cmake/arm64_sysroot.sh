# shellcheck shell=bash
# The libraries of arm64 for cross-building, in a folder of their own: apt resolves and fetches them with a state
# and a cache of its own too, so that the machine is not told of a second architecture and no package of it changes.

# make_arm64_sysroot FOLDER PACKAGE...: unpacks the packages of arm64, and what they depend on, into the folder, from
# the sources apt is configured with. Does nothing where it has done so before; remove the folder for newer ones.
make_arm64_sysroot() {
  local sysroot=$1 wanted work package link target
  shift
  wanted=$*
  [ "$wanted" != "$(cat "$sysroot/packages" 2>/dev/null)" ] || return 0

  work=$(mktemp -d)
  mkdir -p "$work"/{state,cache}
  touch "$work/status" # no package is installed there
  local apt=(apt-get -qq -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State="$work/state"
    -o Dir::State::status="$work/status" -o Dir::Cache="$work/cache" -o Debug::NoLocking=true -o APT::Sandbox::User=
    -o Acquire::Retries=3)
  if ! { "${apt[@]}" update && "${apt[@]}" -y --no-install-recommends --download-only install "$@"; } \
    >"$work/log" 2>&1 </dev/null; then
    cat "$work/log" >&2
    echo "apt-get could not fetch the arm64 packages that packages.txt asks for" >&2
    rm -rf "$work"
    return 1
  fi

  rm -rf "$sysroot"
  mkdir -p "$sysroot"
  for package in "$work"/cache/archives/*.deb; do dpkg-deb -x "$package" "$sysroot"; done
  # An absolute link would lead out of the folder.
  find "$sysroot" -type l -lname '/*' -printf '%p %l\n' | while read -r link target; do
    ln -sfrn "$sysroot$target" "$link"
  done
  rm -rf "$work"
  echo "$wanted" >"$sysroot/packages"
}
