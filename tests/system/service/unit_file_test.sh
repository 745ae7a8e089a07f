#!/bin/sh
# The unit file as systemd reads it: no unknown key, and little exposure. usage: unit_file_test.sh REPOSITORY PROGRAM
# Exit code 77: skipped.
set -eu
repository=$1 program=$2
if ! command -v systemd-analyze > /dev/null; then
  echo "skipped: systemd-analyze is not installed (package systemd)"
  exit 77
fi
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
unit=$folder/edgeslam.service

fail() {
  echo "$*"
  exit 1
}

sed "s|^ExecStart=/usr/bin/edgeslam|ExecStart=$program|" "$repository/systemd/edgeslam.service" > "$unit"
grep -q "^ExecStart=$program run --config " "$unit" || fail "ExecStart is not what is installed"
said=$(systemd-analyze verify "$unit" 2>&1) || fail "the unit file is not valid: $said"
[ -z "$said" ] || fail "the unit file is not clean: $said"

# In tenths: 30 is an exposure of 3.0.
systemd-analyze security --offline=yes --no-pager --threshold=30 "$unit" > "$folder/security" ||
  fail "exposed too much: $(cat "$folder/security")"
grep "Overall exposure" "$folder/security"

for line in Type=notify WatchdogSec= Restart=always StartLimitIntervalSec=0 RestartPreventExitStatus=2 LimitMEMLOCK= LimitRTPRIO=; do
  grep -q "^$line" "$unit" || fail "$line is missing"
done
! grep -q '^RestrictRealtime=yes' "$unit" || fail "RestrictRealtime would take away the priority that LimitRTPRIO gives"
grep -q '^SUBSYSTEM=="video4linux", TAG+="systemd"' "$repository/systemd/70-edgeslam-camera.rules" ||
  fail "without the tag systemd knows of no camera"

# The checks above can fail.
sed 's|^Restart=always|Restrat=always|' "$unit" > "$folder/misspelt.service"
said=$(systemd-analyze verify "$folder/misspelt.service" 2>&1) && [ -z "$said" ] && fail "a misspelt key is not found"
sed '/^SystemCallFilter=/d; /^Protect/d; /^CapabilityBoundingSet=/d; /^DynamicUser=/d; /^User=/d' "$unit" > "$folder/open.service"
! systemd-analyze security --offline=yes --no-pager --threshold=30 "$folder/open.service" > /dev/null ||
  fail "an open service passes"
