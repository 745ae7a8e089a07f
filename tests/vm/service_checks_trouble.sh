# Sourced by service_checks.sh: a covered lens, cameras that go and come back, threads and processes that stall.

longer_than_the_watchdog=12  # [s]

is_not_restarted_for_a_covered_lens() {
  echo "-- covered lens"
  remember_process
  mark
  kill -USR1 "$feeder"
  check "poses end" hears 30 '^SLAM_STATE .* (lost|predicted)'
  sleep $longer_than_the_watchdog
  mark
  check "frames go on" hears 10 '^SLAM_STATE .* (lost|predicted)'
  check "it is not restarted" same_process
  kill -USR2 "$feeder"
  check "uncovered, it finds its place" tracks 90
  check "in the same process" same_process
}

told_in_time() { # PATTERN SECONDS_SINCE_1970
  local told
  told=$(time_said "$1")
  [[ -n $told ]] || return 1
  measured="after $(awk "BEGIN {print $told - $2}") s: $(tail -1 said.txt)"
  awk "BEGIN {exit !($told - $2 < 0.7)}"  # half a second since a frame was due, and what the emulated machine takes
}

outlives_the_camera() {
  echo "-- camera gone and back"
  tracks 60
  remember_process
  mark
  local gone
  end_feed
  gone=$EPOCHREALTIME
  check "no more pictures: the log tells" says 10 'frozen|broke|no frame'
  check "in time" told_in_time 'frozen|broke|no frame' "$gone"
  check "the status tells" hears 10 '^SLAM_STATUS .*lost: '
  sleep $longer_than_the_watchdog
  check "the driver can be taken away" eventually 60 rmmod v4l2loopback
  mark
  check "the status tells that, too" hears 20 '^SLAM_STATUS .*lost: .*(no such|not plugged)'
  sleep $longer_than_the_watchdog
  check "it waits, and is not restarted" same_process
  plug_in
  feed
  check "it comes back, and tracks" tracks 90
  check "it was found again in its map" found_again
  check "in the same process" same_process
}

found_again() { says 5 'found again|relocali|recover'; }

is_restarted_when_it_stalls() {
  echo "-- watchdog"
  check "restarts have no limit" is_property StartLimitIntervalUSec 0
  remember_process
  mark
  ./stall_thread "$before" tracking > stalled.txt 2>&1 &
  check "one thread stalls, of a running program: the watchdog sees it" says 30 'Watchdog timeout'
  check "it is restarted" eventually 60 restarted
  check "poses come again" tracks 90
  remember_process
  mark
  kill -STOP "$before"
  check "the whole program stalls: the watchdog sees it" says 30 'Watchdog timeout'
  check "it is restarted again" eventually 90 restarted
  check "poses come again" tracks 90
  remember_process
  kill -SEGV "$before"
  check "a crash: restarted" eventually 60 restarted
  check "poses come again" tracks 90
}

black() { v4l2-ctl --device "$vivid" --set-ctrl test_pattern="$1" > /dev/null; }

outlives_an_unplugged_camera() {
  echo "-- a camera without contrast, unplugged and plugged in"
  vivid=/dev/v4l/by-path/platform-vivid.0-video-index0
  check "udev gives it a name by its place" test -e $vivid
  sed -i "s|/dev/video42|$vivid, width: 320, height: 180, frame_rate: 10|; s|calibration: .*|calibration: vivid.yaml|" \
    /etc/edgeslam/robot.yaml
  sed 's/^width: .*/width: 320/; s/^height: .*/height: 180/' /etc/edgeslam/camera.yaml > /etc/edgeslam/vivid.yaml
  black "$(v4l2-ctl --device $vivid --list-ctrls-menus | grep -i '100% black' | head -1 | cut -d: -f1)"
  mark
  check "starts" systemctl start edgeslam
  check "frames come" hears 60 '^SLAM_STATE .* initialising'
  remember_process
  sleep $longer_than_the_watchdog
  mark
  check "frames go on" hears 10 '^SLAM_STATE .* initialising'
  check "it is not restarted" same_process
  local round gone
  for round in 1 2 3; do
    mark
    echo vivid.0 > /sys/bus/platform/drivers/vivid/unbind
    gone=$EPOCHREALTIME
    check "unplugged, $round: the log tells" says 10 'not plugged in'
    check "in time" told_in_time 'not plugged in' "$gone"
    check "the status tells" hears 10 '^SLAM_STATUS .*lost: .*not plugged in'
    sleep $((round * 4))
    echo vivid.0 > /sys/bus/platform/drivers/vivid/bind
    mark
    check "plugged in: frames come again" hears 60 '^SLAM_STATE .* initialising'
  done
  check "it was never restarted" same_process
}
