#!/usr/bin/env bash
# same_poses.sh NATIVE OTHER...
# NATIVE is this machine's landfix, OTHER... the command that runs another processor's. Passes if the two build the
# same map file to the byte, and give every pose of a simulated drive within 0.1 mm and 0.001 deg. Not to the byte:
# processors differ in what they fuse, and in how many lanes they sum.
set -euo pipefail
native=$1
shift
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# map_and_replay NAME LANDFIX...: makes NAME.ndt and NAME.tum.
map_and_replay() {
  local result=$folder/$1
  shift
  "$@" map --pcd "$folder/map.pcd" --resolution 1 --output "$result.ndt" >/dev/null
  "$@" replay --config "$folder/config.toml" --map "$result.ndt" --trajectory "$result.tum" >/dev/null
}

# largest KEY: of the differences, as evaluate names them.
largest() { sed -n "/\"$1\"/,/}/s/.*\"max\": \([^,]*\),*$/\1/p" "$folder/differences"; }

"$native" simulate --route street --length 40 --sensor vlp16 --output "$folder" >/dev/null
map_and_replay native "$native"
map_and_replay other "$@"

cmp "$folder/native.ndt" "$folder/other.ndt"
"$native" evaluate --reference "$folder/native.tum" --estimate "$folder/other.tum" --json >"$folder/differences"

# count NAME: of poses; the line that begins with # is none.
count() { awk '!/^#/ { ++poses } END { print poses + 0 }' "$folder/$1.tum"; }

poses=$(count native)
others=$(count other)
pairs=$(sed -n 's/^ *"pairs": \([0-9]*\),*$/\1/p' "$folder/differences")
m=$(largest ate_m)
deg=$(largest ate_deg)
printf '%d and %d poses, %s compared, apart by at most %s m and %s deg\n' "$poses" "$others" "$pairs" "$m" "$deg"
# A figure that evaluate does not give is not a small one: awk would compare an empty word with a number.
awk -v poses="$poses" -v others="$others" -v pairs="$pairs" -v m="$m" -v deg="$deg" \
  'BEGIN { exit !(poses > 20 && others == poses && pairs == poses && m ~ /^[0-9]/ && m <= 1e-4 && deg ~ /^[0-9]/ && deg <= 1e-3) }'
