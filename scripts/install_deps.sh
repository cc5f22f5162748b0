#!/bin/sh
# Installs the Debian 12 packages that Atrium needs; does nothing if all are there.
#   scripts/install_deps.sh build        to build and run the programs
#   scripts/install_deps.sh build web    and to make web pages (.html)
#   scripts/install_deps.sh build test   and to run the tests
#   scripts/install_deps.sh build bench  and to run the benchmarks
#   scripts/install_deps.sh build fuzz   and to fuzz the readers (docs/robustness.md)
#   scripts/install_deps.sh build tidy   and for the preset tidy
set -eu

build="g++ cmake ninja-build ccache pkg-config
  libembree-dev libtbb-dev libeigen3-dev libopenmesh-dev libosd-dev libopenimageio-dev libvtk9-dev libx11-dev
  fonts-dejavu-core
  libcli11-dev nlohmann-json3-dev libyaml-dev libtinygltf-dev libtinyobjloader-dev
  zlib1g-dev"
web="nodejs npm"
test="libgtest-dev libbenchmark-dev xvfb xauth chromium python3"
bench="libbenchmark-dev python3 python3-matplotlib"
fuzz="clang libclang-rt-14-dev libgtest-dev"
tidy="clang clang-tidy libgtest-dev"

wanted=""
for list in "$@"; do
  case "$list" in
    build) wanted="$wanted $build" ;;
    web) command -v npm >/dev/null || wanted="$wanted $web" ;;
    test) wanted="$wanted $test" ;;
    bench) wanted="$wanted $bench" ;;
    fuzz) wanted="$wanted $fuzz" ;;
    tidy) wanted="$wanted $tidy" ;;
    *) echo "install_deps.sh: unknown list '$list' (known: build web test bench fuzz tidy)" >&2; exit 2 ;;
  esac
done

missing=""
for package in $wanted; do
  status=$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" -eq 0 ]; then
  sudo=""
elif command -v sudo >/dev/null; then
  sudo="sudo"
else
  echo "install_deps.sh: run as root or install sudo; missing:$missing" >&2
  exit 1
fi
echo "installing:$missing"
$sudo apt-get update -q
# shellcheck disable=SC2086  # a list of words
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing
