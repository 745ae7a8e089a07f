#!/bin/bash
# The packages in a clean Debian: without errors of lintian, installed with what they ask for, run, built against, upgraded and
# removed without a trace. usage: packages_test.sh SOURCES FOLDER     FOLDER: for the build and the packages
# As root, with a Debian mirror in reach; 77: not here.
set -euo pipefail
sources=$1
folder=$2
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")
most_installed_kib=25000
# What a robot gets with the program, besides a Debian that has systemd.
most_packages=60
most_mib=120
. "$(dirname "${BASH_SOURCE[0]}")/clean_debian.sh"

for tool in mmdebstrap lintian help2man dpkg-shlibdeps; do
  command -v "$tool" > /dev/null || { echo "skipped: no $tool"; exit 77; }
done
((EUID == 0)) || { echo "skipped: not root"; exit 77; }

root=$(mktemp -d --tmpdir edgeslam-packages-XXXXXX)
trap 'remove_clean_debian "$root"' EXIT
arch=$(dpkg --print-architecture)
check() { echo "ok: $*"; }
fail() { echo "FAILED: $*"; exit 1; }
run() { inside "$root" "$@"; }
# run_or_fail NAME COMMAND...: what it says is shown where it fails.
run_or_fail() { run "${@:2}" > "$folder/run.log" 2>&1 || { tail "$folder/run.log"; fail "$1"; }; }
install() { run_or_fail "installation of $*" sh -c "apt-get install -qq -y --no-install-recommends $*"; }
installed() { run dpkg-query -W -f "\${$2}" "$1"; }
# Of a package's files [KiB].
size_of() { run sh -c "dpkg -L $1 | while read -r name; do if [ -f \"\$name\" ] && [ ! -L \"\$name\" ]; then stat -c %s \"\$name\"; fi; done" | awk '{sum += $1} END {printf "%d", sum / 1024}'; }
# Of all packages.
installed_mib() { run dpkg-query -W -f '${Installed-Size}\n' | awk '{sum += $1} END {printf "%d", sum / 1024}'; }
# Everything but what apt and dpkg keep books in.
files() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./var/lib/dpkg -o -path ./var/lib/apt -o -path ./var/cache -o -path ./var/log -o -path ./tmp \) -prune -o -print | sort); }

make_packages() {
  mkdir -p "$folder"
  (cd "$sources" && cmake --preset packages -B "$folder/build") > "$folder/build.log" 2>&1 &&
    cmake --build "$folder/build" --parallel 1 --target edgeslam edgeslam_shared manual_pages >> "$folder/build.log" 2>&1 &&
    rm -rf "$folder"/*.{deb,ddeb} && (cd "$folder/build" && cpack -G DEB -B "$folder") >> "$folder/build.log" 2>&1 ||
    { tail -20 "$folder/build.log"; fail "build of the packages"; }
  rm -rf "$folder/_CPack_Packages"
  ls -l "$folder"/*.{deb,ddeb} | awk '{print $5 " bytes", $9}' | sed "s#$folder/##"
  for package in edgeslam_*.deb edgeslam-tools_*.deb libedgeslam2_*.deb libedgeslam-dev_*.deb edgeslam-dbgsym_*.ddeb libedgeslam2-dbgsym_*.ddeb; do
    [[ -n $(compgen -G "$folder/$package") ]] || fail "no package $package"
  done
  local errors
  errors=$(lintian --tag-display-limit 0 "$folder"/*.deb 2>&1 | tee "$folder/lintian.log" | grep -c '^E:' || true)
  ((errors == 0)) || { grep '^E:' "$folder/lintian.log"; fail "lintian"; }
  check "lintian has no errors, $(grep -c '^W:' "$folder/lintian.log" || true) warnings"
}

install_program() {
  make_clean_debian "$suite" "$root"
  install systemd
  files > "$folder/before.txt"
  cp "$folder"/*.{deb,ddeb} "$root/tmp/"
  local packages_before mib_before packages mib
  packages_before=$(run dpkg-query -W | wc -l)
  mib_before=$(installed_mib)
  install "/tmp/edgeslam_*_$arch.deb"
  packages=$(($(run dpkg-query -W | wc -l) - packages_before))
  mib=$(($(installed_mib) - mib_before))
  check "installed: $(size_of edgeslam) KiB; with what it needs $packages packages, $mib MiB"
  (($(size_of edgeslam) < most_installed_kib)) || fail "more than $most_installed_kib KiB"
  ((packages <= most_packages && mib <= most_mib)) || fail "more than $most_packages packages or $most_mib MiB"
}

run_program() {
  [[ $(run edgeslam --version) == "edgeslam $(installed edgeslam Version)" ]] || fail "--version"
  run_or_fail "the default configuration" edgeslam check-config /etc/edgeslam/robot.yaml
  run_or_fail "no user edgeslam" getent passwd edgeslam
  local problems
  problems=$(run systemd-analyze verify /lib/systemd/system/edgeslam.service 2>&1 | grep -i "edgeslam" || true)
  [[ -z $problems ]] || fail "the unit: $problems"
  local subcommands
  subcommands=$(run edgeslam --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z-]*\) .*/\1/p')
  (($(wc -w <<< "$subcommands") >= 8)) || fail "subcommands of --help not understood: $subcommands"
  for page in edgeslam $(sed 's/^/edgeslam-/' <<< "$subcommands"); do
    [[ -s $root/usr/share/man/man1/$page.1.gz ]] || fail "no manual page $page"
  done
  run_or_fail simulate edgeslam simulate panels --frames 60 --width 320 --height 240 --output /tmp/recording
  run_or_fail replay edgeslam replay /tmp/recording --output /tmp/result
  [[ -s $root/tmp/result/trajectory.txt && -s $root/tmp/result/report.html ]] || fail "no result"
  check "the program runs: check-config, simulate, replay"
}

# What is in edgeslam-tools is named without it, and works with it.
add_tools() {
  local packages_before said
  packages_before=$(run dpkg-query -W | wc -l)
  head -c 1000 /dev/zero > "$root/tmp/walk.mp4"
  said=$(run edgeslam replay /tmp/walk.mp4 --output /tmp/result 2>&1 || true)
  [[ $said == *"/tmp/walk.mp4: videos are read by the package edgeslam-tools"* ]] || fail "of a video without the tools it says: $said"
  board="edgeslam calibrate board --type charuco --columns 8 --rows 6 --square 20mm --output /tmp/board.pdf"
  said=$(run $board 2>&1 || true)
  [[ $said == *"boards with markers need the package edgeslam-tools"* ]] || fail "of markers without the tools it says: $said"
  run_or_fail "a chessboard without the tools" ${board/charuco/chessboard}
  rm "$root/tmp/board.pdf"
  install "/tmp/edgeslam-tools_*_$arch.deb"
  said=$(run edgeslam replay /tmp/walk.mp4 --output /tmp/result 2>&1 || true)
  [[ $said == *"/tmp/walk.mp4: cannot be opened as a video"* ]] || fail "of no video it says: $said"
  run_or_fail "a board with markers" $board
  check "the tools: $(($(run dpkg-query -W | wc -l) - packages_before)) packages; videos and markers"
}

build_against_library() {
  install "/tmp/libedgeslam2_*.deb /tmp/libedgeslam-dev_*.deb g++ make cmake"
  check "the library: $(size_of libedgeslam2) KiB"
  cp -r "$sources/tests/package/find_package" "$root/tmp/"
  cp -r "$root/usr/share/doc/libedgeslam-dev/examples" "$root/tmp/"
  printf 'camera: {calibration: /tmp/recording/camera.yaml}\n' > "$root/tmp/robot.yaml"
  run_or_fail "find_package" sh -c "cmake -S /tmp/find_package -B /tmp/find_package/build -DEDGESLAM_VERSION=$(installed libedgeslam-dev Version) &&
    cmake --build /tmp/find_package/build && /tmp/find_package/build/edgeslam_user /tmp/robot.yaml"
  run_or_fail "the example does not build" sh -c "cmake -S /tmp/examples -B /tmp/examples/build && cmake --build /tmp/examples/build"
  mkdir "$root/tmp/frames"
  python3 "$sources/tests/package/pgm_folder.py" "$root/tmp/recording" "$root/tmp/frames"
  run_or_fail "the example does not run" sh -c "/tmp/examples/build/1_images_to_poses /tmp/robot.yaml /tmp/frames > /tmp/trajectory.txt"
  local poses
  poses=$(wc -l < "$root/tmp/trajectory.txt")
  ((poses >= 10)) || fail "the example gives $poses poses"
  check "programs are built against the installed library; the example gives $poses poses"
}

# In the package of symbols a function of the library has its name, file and line.
look_at_symbols() {
  run_or_fail "installation of the symbols" sh -c "dpkg -i /tmp/*-dbgsym_*.ddeb"
  local library address place build_id
  for name in /usr/bin/edgeslam "/usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)/libedgeslam.so.2"; do
    library=$(run readlink -f "$name")
    build_id=$(run readelf -n "$library" | sed -n 's/.*Build ID: //p')
    [[ -s $root/usr/lib/debug/.build-id/${build_id::2}/${build_id:2}.debug ]] || fail "no symbols of $name"
  done
  address=$(run nm --dynamic --demangle "$library" | sed -n 's/^\([0-9a-f]*\) T edgeslam::Slam::process(.*/\1/p')
  place=$(run addr2line -f -C -e "/usr/lib/debug/.build-id/${build_id::2}/${build_id:2}.debug" "0x$address" | tr '\n' ' ')
  [[ $place == *edgeslam::Slam::process*src/library/slam.cpp:[1-9]* ]] || fail "symbols: $place"
  check "symbols: ${place% }, of $(size_of edgeslam-dbgsym) and $(size_of libedgeslam2-dbgsym) KiB"
}

upgrade_and_remove() {
  echo "# mine" >> "$root/etc/edgeslam/robot.yaml"
  run_or_fail "installation over itself" sh -c "dpkg -i /tmp/edgeslam_*_$arch.deb"
  grep -q "^# mine" "$root/etc/edgeslam/robot.yaml" || fail "an upgrade changes the user's configuration"
  check "an upgrade keeps the user's configuration"
  run_or_fail removal sh -c "apt-get purge -qq -y edgeslam edgeslam-tools libedgeslam2 libedgeslam-dev && apt-get autoremove -qq -y --purge"
  local left
  left=$(comm -13 "$folder/before.txt" <(files) | grep -i edgeslam || true)
  [[ -z $left ]] || { echo "$left"; fail "removal leaves these"; }
  check "removal leaves nothing"
}

make_packages
install_program
run_program
add_tools
build_against_library
look_at_symbols
upgrade_and_remove
