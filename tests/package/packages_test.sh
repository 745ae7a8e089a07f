#!/bin/bash
# The packages in a clean Debian: without errors of lintian, installed with what they ask for, run, built against, upgraded and
# removed without a trace. usage: packages_test.sh SOURCES BUILD     As root, with a Debian mirror in reach; 77: not here.
set -euo pipefail
sources=$1
build=$2
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")

for tool in mmdebstrap lintian help2man dpkg-shlibdeps; do
  command -v "$tool" > /dev/null || { echo "skipped: no $tool"; exit 77; }
done
((EUID == 0)) || { echo "skipped: not root"; exit 77; }

root=$(mktemp -d --tmpdir edgeslam-packages-XXXXXX)
trap 'umount "$root/proc" 2> /dev/null || true; rm -rf "$root"' EXIT
check() { echo "ok: $*"; }
fail() { echo "FAILED: $*"; exit 1; }
inside() { chroot "$root" /usr/bin/env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive "$@"; }
# Everything but what apt and dpkg keep books in.
files() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./var/lib/dpkg -o -path ./var/lib/apt -o -path ./var/cache -o -path ./var/log -o -path ./tmp \) -prune -o -print | sort); }

cmake --build "$build" --target manual_pages edgeslam edgeslam_shared > "$build/packages.log"
rm -rf "$build/packages"
(cd "$build" && cpack -G DEB -B packages) >> "$build/packages.log" || { tail -20 "$build/packages.log"; fail "cpack"; }
rm -rf "$build/packages/_CPack_Packages"
ls -l "$build"/packages/*.deb | awk '{print $5 " bytes", $9}' | sed "s#$build/##"

errors=$(lintian --tag-display-limit 0 "$build"/packages/*.deb 2>&1 | tee "$build/lintian.log" | grep -c '^E:' || true)
((errors == 0)) || { grep '^E:' "$build/lintian.log"; fail "lintian"; }
check "lintian has no errors, $(grep -c '^W:' "$build/lintian.log" || true) warnings"

mmdebstrap --variant=apt --quiet --include=ca-certificates "$suite" "$root" > /dev/null
mount -t proc proc "$root/proc"
inside apt-get install -qq -y --no-install-recommends systemd > /dev/null 2>&1
files > "$build/before.txt"
cp "$build"/packages/*.deb "$root/tmp/"
arch=$(dpkg --print-architecture)
inside sh -c "apt-get install -qq -y --no-install-recommends /tmp/edgeslam_*_$arch.deb" > "$build/install.log" 2>&1 ||
  { tail "$build/install.log"; fail "installation"; }
check "installed, with $(inside dpkg-query -W | wc -l) packages in all"

[[ $(inside edgeslam --version) == "edgeslam $(inside dpkg-query -W -f '${Version}' edgeslam)" ]] || fail "--version"
inside edgeslam check-config /etc/edgeslam/robot.yaml > /dev/null || fail "the default configuration is no good one"
inside getent passwd edgeslam > /dev/null || fail "no user edgeslam"
inside systemd-analyze verify /lib/systemd/system/edgeslam.service 2>&1 | grep -i "edgeslam" && fail "the unit" || true
for page in edgeslam edgeslam-run edgeslam-replay edgeslam-check-config; do
  [[ -s $root/usr/share/man/man1/$page.1.gz ]] || fail "no manual page $page"
done
inside edgeslam simulate panels --frames 60 --width 320 --height 240 --output /tmp/recording > /dev/null 2>&1
inside edgeslam replay /tmp/recording --output /tmp/result > /dev/null 2>&1 || fail "replay"
[[ -s $root/tmp/result/trajectory.txt && -s $root/tmp/result/report.html ]] || fail "no result"
check "the program runs: check-config, simulate, replay"

inside sh -c "apt-get install -qq -y --no-install-recommends /tmp/libedgeslam0_*.deb /tmp/libedgeslam-dev_*.deb g++ make cmake" > "$build/install.log" 2>&1 ||
  { tail "$build/install.log"; fail "installation of the library"; }
inside sh -c "cp -r /usr/share/doc/libedgeslam-dev/examples /tmp/ && cmake -S /tmp/examples -B /tmp/examples/build && cmake --build /tmp/examples/build" > "$build/example.log" 2>&1 ||
  { tail "$build/example.log"; fail "the example does not build"; }
mkdir "$root/tmp/frames"
python3 "$sources/tests/package/pgm_folder.py" "$root/tmp/recording" "$root/tmp/frames"
printf 'camera: {calibration: /tmp/recording/camera.yaml}\n' > "$root/tmp/robot.yaml"
inside sh -c "/tmp/examples/build/track_images /tmp/robot.yaml /tmp/frames > /tmp/trajectory.txt" 2> /dev/null || fail "the example does not run"
[[ $(wc -l < "$root/tmp/trajectory.txt") -ge 10 ]] || fail "the example gives $(wc -l < "$root/tmp/trajectory.txt") poses"
check "a program built against the installed library gives $(wc -l < "$root/tmp/trajectory.txt") poses"

echo "# mine" >> "$root/etc/edgeslam/robot.yaml"
inside sh -c "dpkg -i /tmp/edgeslam_*_$arch.deb" > "$build/install.log" 2>&1 || fail "installation over itself"
grep -q "^# mine" "$root/etc/edgeslam/robot.yaml" || fail "an upgrade changes the user's configuration"
check "an upgrade keeps the user's configuration"

inside sh -c "apt-get purge -qq -y edgeslam libedgeslam0 libedgeslam-dev && apt-get autoremove -qq -y --purge" > /dev/null 2>&1 || fail "removal"
left=$(comm -13 "$build/before.txt" <(files) | grep -i edgeslam || true)
[[ -z $left ]] || { echo "$left"; fail "removal leaves these"; }
check "removal leaves nothing"
