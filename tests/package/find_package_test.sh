#!/bin/bash
# The library, installed into a folder, is found by CMake, with its version, and works.
# usage: find_package_test.sh BUILD VERSION CXX_COMPILER
set -euo pipefail
build=$1
version=$2
compiler=$3
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

folder=$(mktemp -d --tmpdir="$build" find_package-XXXXXX)
trap 'rm -rf "$folder"' EXIT
for component in libedgeslam2 libedgeslam-dev; do
  cmake --install "$build" --component "$component" --prefix "$folder/installed" > "$folder/log" || { cat "$folder/log"; exit 1; }
done
for project in "$here/find_package" "$folder/installed/share/doc/libedgeslam-dev/examples"; do
  cmake -S "$project" -B "$folder/$(basename "$project")" -DCMAKE_PREFIX_PATH="$folder/installed" -DCMAKE_CXX_COMPILER="$compiler" \
    -DEDGESLAM_VERSION="$version" --no-warn-unused-cli > "$folder/log" 2>&1 &&
    cmake --build "$folder/$(basename "$project")" >> "$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
done

cat > "$folder/camera.yaml" <<'EOF'
{width: 320, height: 240, fx: 260, fy: 260, cx: 159.5, cy: 119.5}
EOF
echo "camera: {calibration: $folder/camera.yaml}" > "$folder/robot.yaml"
"$folder/find_package/edgeslam_user" "$folder/robot.yaml"
said=$("$folder/examples/1_images_to_poses" "$folder/robot.yaml" "$folder/none" 2>&1 || true)
[[ $said == "1_images_to_poses: "*none* ]] || { echo "of a folder that is not there the example says: $said"; exit 1; }
