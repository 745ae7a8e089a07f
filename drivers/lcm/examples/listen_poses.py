#!/usr/bin/env python3
"""Prints SLAM_POSE, where it is of another map than before, and when and why SLAM_ODOMETRY was corrected. Needs the types that `lcm-gen --python` writes, on PYTHONPATH, and nothing else."""
import socket
import struct
from edgeslam import correction_t, pose_t, state_t

GROUP, PORT = "239.255.76.67", 7667
receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
receiver.bind((GROUP, PORT))
receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, struct.pack("4sL", socket.inet_aton(GROUP), socket.INADDR_ANY))
print("ready", flush=True)
world, changed = 0, 0
REASONS = ["start", "map adjusted", "map corrected", "found again", "measured again", "another map", "scale"]
while True:
    packet = receiver.recv(65536)
    if packet[:4] != b"LC02":  # a short message: magic, number, channel, a zero byte, the type's bytes
        continue
    channel, _, content = packet[8:].partition(b"\0")
    if channel == b"SLAM_POSE":
        pose = pose_t.decode(content)
        print(f"{pose.utime / 1e6:.6f} s, position {pose.pos}, quaternion {pose.orientation}", flush=True)
    if channel == b"SLAM_STATE":
        state = state_t.decode(content)
        if state.has_pose and state.world != world:
            print(f"map {state.world}: its coordinates and unit are its own", flush=True)
            world = state.world
    if channel == b"SLAM_CORRECTION":
        correction = correction_t.decode(content)
        if correction.change_utime != changed:
            changed = correction.change_utime
            print(f"{changed / 1e6:.6f} s, odom is at {correction.translation} of the map: {REASONS[correction.change]}, {correction.reset_count} resets", flush=True)
