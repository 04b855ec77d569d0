# shellcheck shell=bash
# What ./demo and ./check share. Sourced by a script that has set `root` to the repository's folder.
: "${root:?}"

# show_help: the comment that opens the script.
show_help() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$root/$(basename "$0")"; }

# step TEXT: says what happens now, after the minutes and seconds since the script began.
step() {
  # shellcheck disable=SC2034 # ./demo says where it stopped
  current_step=$*
  printf '\n[%d:%02d] %s\n' $((SECONDS / 60)) $((SECONDS % 60)) "$*"
}

# packages SECTION...: the packages in these sections of packages.txt.
packages() {
  local section
  for section; do
    awk -v wanted="[$section]" '/^\[/ { here = ($1 == wanted); next } here && NF && !/^#/ { print $1 }' \
      "$root/packages.txt"
  done
}

# install_packages SECTION...: installs what is missing, through sudo where that is needed; calls no apt where
# nothing is.
install_packages() {
  local wanted installed missing as_root=() log
  if ! command -v dpkg-query >/dev/null; then
    echo "This is not Debian: install what packages.txt lists ($*) by this system's means." >&2
    return 0
  fi
  wanted=$(packages "$@" | sort -u)
  # shellcheck disable=SC2086,SC2016 # one word a package; the ${...} is dpkg-query's own; it fails where one is unknown
  installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $wanted 2>/dev/null |
    awk '$1 == "installed" { print $2 }' | sort -u) || true
  missing=$(comm -23 <(echo "$wanted") <(echo "$installed") | xargs)
  [ -n "$missing" ] || return 0

  if [ "$(id -u)" != 0 ]; then
    if command -v sudo >/dev/null && { [ -t 0 ] || sudo -n true 2>/dev/null; }; then
      as_root=(sudo)
    else
      echo "Packages are missing, and installing them needs root. As root:" >&2
      echo "  apt-get update && apt-get install --no-install-recommends $missing" >&2
      return 1
    fi
  fi
  echo "Installing $missing"
  log=$(mktemp)
  # shellcheck disable=SC2086 # one word a package
  if ! { "${as_root[@]}" apt-get -qq -o Acquire::Retries=3 update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends \
      -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300 install $missing; } >"$log" 2>&1 </dev/null; then
    cat "$log" >&2
    rm -f "$log"
    echo "apt-get could not install: $missing" >&2
    return 1
  fi
  rm -f "$log"
}

# configure PRESET [OPTION...]: runs CMake, which speaks only of problems.
configure() {
  (cd "$root" && cmake --preset "$@" --log-level=WARNING >/dev/null)
}

# build PRESET [OPTION...]: a terminal sees the progress, a log only the problems.
build() {
  local quiet=()
  [ -t 1 ] || quiet=(-- --quiet)
  (cd "$root" && cmake --build --preset "$@" "${quiet[@]}")
}
