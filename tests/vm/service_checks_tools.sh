# Sourced by service_checks.sh: a line for each check, and what the checks ask of systemd, the journal and the listener.

checks=0 failures=0

# check TEXT COMMAND...: "ok" where the command ends well. What the command puts into $measured is told, too.
check() {
  local text=$1
  shift
  measured=""
  checks=$((checks + 1))
  if "$@"; then
    echo "ok      $text${measured:+ ($measured)}"
  else
    failures=$((failures + 1))
    echo "FAILED  $text${measured:+ ($measured)}"
    journalctl --quiet --output cat --unit edgeslam | grep '^edgeslam: ' | tail -4 | sed 's/^/        /'
  fi
}

# Everything is slower in an emulated machine that shares its processors with others.
eventually() { # SECONDS COMMAND...
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    ((SECONDS < end)) || return 1
    sleep 0.5
  done
}

is_not() { ! "$@"; }

property() { systemctl show --property "$1" --value edgeslam; }
is_property() { # NAME VALUE
  measured="$1=$(property "$1")"
  [[ $measured == "$1=$2" ]]
}
process() { property MainPID; }
unit_is() { is_property ActiveState "$1"; }

# From here on: what was heard and said before does not count.
mark() {
  heard_before=$(wc -l < heard.txt)
  said_before=$(journalctl --quiet --output cat --unit edgeslam | wc -l)
}
heard() { tail -n +$((heard_before + 1)) heard.txt | grep -qE -- "$1"; }
heard_times() { tail -n +$((heard_before + 1)) heard.txt | grep -cE -- "$1"; }
said() { journalctl --quiet --output cat --unit edgeslam | tail -n +$((said_before + 1)) | grep -E -- "$1" > said.txt; }
# Of the last line that says it [s since 1970].
time_said() { journalctl --quiet --output short-unix --unit edgeslam | grep -E -- "$1" | tail -1 | cut -d' ' -f1; }

hears() { eventually "$1" heard "$2"; }
says() { # SECONDS PATTERN
  eventually "$1" said "$2" && measured=$(tail -1 said.txt)
}
tracks() { # SECONDS: from now on
  mark
  hears "$1" '^SLAM_STATE .*(tracking|recovered|relocalised), at ' && measured=$(tail -n +$((heard_before + 1)) heard.txt |
    grep -E '^SLAM_STATE .*(tracking|recovered|relocalised), at ' | head -1 | sed 's/, at .*//')
}

# The same process as `before`, and never restarted since.
same_process() {
  measured="process $before, now $(process)"
  [[ $(process) == "$before" && $(property NRestarts) == "$restarts_before" ]]
}
restarted() {
  local now
  now=$(process)
  measured="NRestarts $restarts_before, now $(property NRestarts); process $before, now $now"
  [[ $(property NRestarts) == $((restarts_before + 1)) && $now != "$before" && $now != 0 ]]
}
remember_process() {
  before=$(process)
  restarts_before=$(property NRestarts)
}

# The camera is there, without a picture before feed().
plug_in() {
  insmod modules/v4l2loopback.ko video_nr=42 exclusive_caps=0 card_label=Loopback
  udevadm settle
}
feed() {
  ./feed_loopback /dev/video42 sequence 10 > feeder.txt 2>&1 &
  feeder=$!
}
end_feed() {
  kill "$feeder"
  wait "$feeder"
}
