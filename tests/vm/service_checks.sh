#!/bin/bash
# Runs in the guest of service.sh, as a unit beside the service: every check prints its line.
cd /opt/checks || exit 1
source ./service_checks_tools.sh
source ./service_checks_confinement.sh
source ./service_checks_trouble.sh

prepare() {
  ip route add 224.0.0.0/4 dev lo
  mkdir -p /mnt/results
  mount -t 9p -o trans=virtio,version=9p2000.L results /mnt/results
  edgeslam listen > heard.txt 2> listener.txt &
  mark
}

starts_with_the_computer() {
  echo "-- start"
  check "started at boot, and ready before there is a camera" eventually 120 unit_is active
  check "by its own word" is_property Type notify
  check "that there is none is told" hears 30 '^SLAM_STATUS .*lost: .*/dev/video42'
  plug_in
  feed
  check "it is plugged in: the camera is found in the map" tracks 120
  mark
  check "poses" hears 10 '^SLAM_POSE t '
  check "odometry" hears 10 '^SLAM_REL_ODOMETRY .*valid'
  check "status" hears 10 '^SLAM_STATUS .* tracking, .*frames/s'
  sleep 10
  measured=""
  check "no message is lost on the way" is_not heard 'lost before this'
  echo "        $(tail -n +$((heard_before + 1)) heard.txt | grep '^SLAM_STATUS' | tail -1)"
  echo "        $(property StatusText)"
}

ends() {
  echo "-- end"
  check "the service runs" tracks 60
  systemctl reload edgeslam
  check "reload writes the map" says 20 'saved to .*robot.map'
  rm -f /var/lib/edgeslam/robot.map
  local from=$EPOCHREALTIME
  check "systemctl stop ends well" systemctl stop edgeslam
  echo "        after $(awk "BEGIN {print $EPOCHREALTIME - $from}") s"
  check "not by force" is_property Result success
  check "exit code 0" is_property ExecMainStatus 0
  check "the map is written" says 5 'map of [0-9]+ keyframes saved to .*robot.map'
  check "in the service's folder" test -s /var/lib/edgeslam/robot.map
  check "the log is no flood" no_flood
}

no_flood() {
  measured="$(journalctl --quiet --output cat --unit edgeslam | grep -c '^edgeslam: ') lines in $SECONDS s"
  (($(journalctl --quiet --output cat --unit edgeslam | grep -c '^edgeslam: ') < SECONDS / 2))
}

told_wrong_configuration() {
  echo "-- wrong configuration"
  cp /etc/edgeslam/robot.yaml robot.yaml
  echo 'edges: {sigam: 2}' >> /etc/edgeslam/robot.yaml
  mark
  check "does not start" is_not systemctl start edgeslam 2> /dev/null
  check "file, line and key are told" says 10 'robot.yaml:[0-9]+: edges.sigam is not a key'
  sleep 10
  check "exit code 2" is_property ExecMainStatus 2
  check "is not restarted" is_property NRestarts 0
  check "has failed" unit_is failed
  cp robot.yaml /etc/edgeslam/robot.yaml
  check "mended, it starts" systemctl start edgeslam
  check "and tracks" tracks 90
  systemctl stop edgeslam
}

# For those who look into a failure, on the host.
keep_results() {
  journalctl --quiet --output short-precise > /mnt/results/journal.txt
  cp heard.txt listener.txt feeder.txt /mnt/results/
}

prepare
for part in starts_with_the_computer is_confined is_not_restarted_for_a_covered_lens outlives_the_camera \
  is_restarted_when_it_stalls ends told_wrong_configuration outlives_an_unplugged_camera; do
  $part
  keep_results
done
umount /mnt/results
if ((failures == 0)); then
  echo "service checks: all passed, $checks"
else
  echo "service checks: $failures of $checks FAILED"
fi
