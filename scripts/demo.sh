#!/bin/sh
# From a bare Debian 12 to a picture: installs, configures, builds and renders a scene of this
# repository. Running it again only renders.
set -eu
cd "$(dirname "$0")/.."

scripts/install_deps.sh build
cmake --preset release >/dev/null
cmake --build --preset release

scene=scenes/office/office.yaml
name=$(basename "$scene" .yaml)
out=build/demo
mkdir -p "$out"
atrium=build/release/bin/atrium

# Solved once: the mesh is for viewers, the solution for pictures from any camera.
"$atrium" solve "$scene" -o "$out/$name.vtp" -o "$out/$name.atrium"
"$atrium" render "$scene" --solution "$out/$name.atrium" -o "$out/$name.exr" -o "$out/$name.png" \
  --stats "$out/$name.json"

echo
echo "picture, linear with layers: $PWD/$out/$name.exr"
echo "picture, tone mapped:        $PWD/$out/$name.png"
echo "radiosity mesh:              $PWD/$out/$name.vtp   (build/release/bin/atrium-view shows it)"
echo "statistics:                  $PWD/$out/$name.json"
