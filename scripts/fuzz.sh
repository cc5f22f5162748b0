#!/bin/sh
# Fuzzes one reader and appends a line to docs/fuzz_log.csv.
#   scripts/fuzz.sh TARGET SECONDS [FOLDER...]   folders of more files to start from
# Builds the fuzz targets first (preset fuzz; not with ATRIUM_FUZZ_AS_BUILT=1). The corpus stays in build/fuzz/corpus/TARGET, what breaks
# the reader goes to build/fuzz/findings/TARGET; the exit code is libFuzzer's.
set -eu
cd "$(dirname "$0")/.."
[ $# -ge 2 ] || { echo "usage: scripts/fuzz.sh TARGET SECONDS [FOLDER...]" >&2; exit 2; }
target=$1
seconds=$2
shift 2
log=docs/fuzz_log.csv
corpus=build/fuzz/corpus/$target
findings=build/fuzz/findings/$target
dictionary=build/fuzz/$target.dict
run=build/fuzz/$target.log

[ -f build/fuzz/CMakeCache.txt ] || cmake --preset fuzz >/dev/null
case "$target" in vtp | vtu) program=fuzz_readers_vtk ;; *) program=fuzz_readers ;; esac
[ -n "${ATRIUM_FUZZ_AS_BUILT:-}" ] || ninja -C build/fuzz "$program" >/dev/null
mkdir -p "$corpus" "$findings"

# The words of a format are those that its reader has in quotes.
scene=libtrace/scene/src
case "$target" in
  gltf | glb) sources="$scene/gltf_*.cpp $scene/read_gltf.cpp /usr/include/tiny_gltf.h" ;;
  obj) sources="$scene/read_obj.cpp $scene/obj_material.cpp /usr/include/tiny_obj_loader.h" ;;
  yaml) sources="$scene/yaml_*.cpp $scene/read_yaml.cpp" ;;
  material) sources="apps/material_query/*.cpp" ;;
  walk) sources="$scene/yaml_path.cpp" ;;
  config) sources="apps/atrium/parse*.cpp apps/common/cli_options.cpp" ;;
  vtp | vtu) sources="tests/fuzz/seeds/$target/*" ;;
  *) sources="$scene/read_$target.cpp" ;;
esac
# shellcheck disable=SC2086  # a list of patterns
cat $sources 2>/dev/null | grep -o '"[A-Za-z][A-Za-z0-9_ :=-]\{0,40\}"' | sort -u >"$dictionary"
options="-detect_leaks=0"  # OpenImageIO keeps its messages
[ -s "$dictionary" ] && options="$options -dict=$dictionary"

seeds=""
for folder in "tests/fuzz/seeds/$target" "tests/fuzz/regressions/$target" "$@"; do
  [ -d "$folder" ] && seeds="$seeds $folder"
done
before=$(find "$findings" -type f | wc -l)
# Sanitised programs need about three times the memory; one allocation of 512 MB from an input of at
# most 64 KiB is a finding.
status=0
# shellcheck disable=SC2086  # lists of options and folders
ASAN_OPTIONS=detect_leaks=0 bash -c 'time "$@"' fuzz "build/fuzz/bin/$program" "$target" $options -max_total_time="$seconds" \
  -max_len=65536 -timeout=300 -report_slow_units=300 -rss_limit_mb=3000 -malloc_limit_mb=512 -print_final_stats=1 \
  -artifact_prefix="$findings/" "$corpus" $seeds >"$run" 2>&1 || status=$?

cpu=$(awk '/^(user|sys)/ { split($2, t, /[ms]/); sum += 60 * t[1] + t[2] } END { printf "%.0f", sum }' "$run")
executions=$(awk '/number_of_executed_units/ { n = $2 } END { print n + 0 }' "$run")
coverage=$(awk '/ cov: / { for (i = 1; i < NF; ++i) if ($i == "cov:") c = $(i + 1) } END { print c + 0 }' "$run")
found=$(($(find "$findings" -type f | wc -l) - before))
[ -f "$log" ] || echo "date,commit,target,cpu_s,executions,coverage,corpus,findings" >"$log"
echo "$(date -u +%FT%H:%M),$(git rev-parse --short HEAD),$target,$cpu,$executions,$coverage,$(find "$corpus" -type f | wc -l),$found" |
  tee -a "$log"
exit "$status"
