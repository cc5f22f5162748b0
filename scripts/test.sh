#!/bin/sh
# Installs what the tests need, builds everything, benchmark programs too, and runs all tests, then the
# readers' tests again under GCC's sanitizers. The exit code is that of the first step that fails.
set -eu
cd "$(dirname "$0")/.."

scripts/install_deps.sh build web test
cmake --preset release -DATRIUM_BUILD_BENCHMARKS=ON >/dev/null
cmake --build --preset release
ctest --test-dir build/release -j2 --output-on-failure

# AddressSanitizer of GCC 12 crashes now and then where more than 28 bits of addresses are random, in
# the build as well, which asks test programs for their tests.
fixed=""
bits=$(cat /proc/sys/vm/mmap_rnd_bits 2>/dev/null || echo 0)
if [ "$bits" -gt 28 ]; then
  fixed="setarch $(uname -m) -R"
  if ! $fixed true 2>/dev/null; then
    echo "test.sh: no tests under sanitizers: vm.mmap_rnd_bits is $bits, and setarch -R is not allowed"
    exit 0
  fi
fi
cmake --preset sanitize >/dev/null
$fixed cmake --build --preset sanitize
exec $fixed ctest --preset sanitize -j2
