#!/bin/bash
# The packages for arm64: what they ask for is to be had, and the program runs in a Debian that has just that.
# usage: packages.sh FOLDER     As root, with a Debian mirror in reach; 77: not here.
set -euo pipefail
folder=$1
suite=$(. /etc/os-release && echo "$VERSION_CODENAME")

[[ -x $folder/build/edgeslam ]] || { echo "skipped: no build"; exit 77; }
for tool in mmdebstrap dpkg-shlibdeps help2man; do
  command -v "$tool" > /dev/null || { echo "skipped: no $tool"; exit 77; }
done

root=$(mktemp -d --tmpdir edgeslam-arm-XXXXXX)
trap 'rm -rf "$root"' EXIT
fail() { echo "FAILED: $*"; exit 1; }

cmake --build "$folder/build" --parallel 1 --target edgeslam edgeslam_shared manual_pages > "$folder/packages.log" 2>&1 ||
  { tail -20 "$folder/packages.log"; fail "build"; }
rm -rf "$folder/packages"
(cd "$folder/build" && cpack -G DEB -B "$folder/packages") >> "$folder/packages.log" 2>&1 || { tail -20 "$folder/packages.log"; fail "cpack"; }
rm -rf "$folder/packages/_CPack_Packages"
ls -l "$folder"/packages/*.deb | awk '{print $5 " bytes", $9}' | sed "s#$folder/##"

for package in edgeslam_*.deb libedgeslam2_*.deb libedgeslam-dev_*.deb edgeslam-dbgsym_*.ddeb libedgeslam2-dbgsym_*.ddeb; do
  [[ -n $(compgen -G "$folder/packages/$package") ]] || fail "no package $package"
done
package=$(echo "$folder"/packages/edgeslam_*_arm64.deb)
[[ $(dpkg-deb -f "$package" Architecture) == arm64 ]] || fail "architecture: $(dpkg-deb -f "$package" Architecture)"
depends=$(dpkg-deb -f "$package" Depends)
echo "depends: $depends"
for library in libc6 libceres3 liblcm1 libsystemd0; do
  [[ $depends == *$library* ]] || fail "it does not depend on $library"
done

# No script of a package can run without an ARM processor: what libraries would link, is linked.
needed=$(sed -E 's/ *\([^)]*\)//g; s/ *\|[^,]*//g; s/, */ /g' <<< "$depends")
mmdebstrap --quiet --variant=extract --architectures=arm64 --mode=root --skip=chroot/mount \
  --include="$(tr -s ' ' , <<< "$needed")" "$suite" "$root"
libraries=$root/usr/lib/aarch64-linux-gnu
for name in libblas.so.3 liblapack.so.3; do
  ln -sf "$(cd "$libraries" && find . -mindepth 2 -name "$name" | sort | head -1)" "$libraries/$name"
done
dpkg-deb -x "$package" "$root"
cp "$(command -v qemu-aarch64-static)" "$root/qemu"
run() { chroot "$root" /qemu /usr/bin/edgeslam "$@"; }

[[ $(run --version) == "edgeslam $(dpkg-deb -f "$package" Version)" ]] || fail "--version"
run check-config /etc/edgeslam/robot.yaml > /dev/null || fail "the default configuration is no good one"
run simulate panels --frames 30 --width 320 --height 240 --output /recording > /dev/null 2>&1 || fail "simulate"
run replay /recording --output /result > "$folder/replay.log" 2>&1 || { tail -3 "$folder/replay.log"; fail "replay"; }
[[ -s $root/result/trajectory.txt && -s $root/result/report.html ]] || fail "no result"
echo "ok: installed, with what it depends on, it runs: check-config, simulate, replay"
