#!/bin/sh
# Installs what the tests need, builds everything and runs all tests; the exit code is ctest's.
set -eu
cd "$(dirname "$0")/.."

scripts/install_deps.sh build web test
cmake --preset release >/dev/null
cmake --build --preset release
exec ctest --test-dir build/release -j2 --output-on-failure
