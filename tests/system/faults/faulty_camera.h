// A V4L2 camera that plays frames at 30 a second, there and back without end, and has the trouble that a test wants:
// preloaded (LD_PRELOAD=libfaulty_camera.so) it takes the place of the C library's functions for its device.
#pragma once

namespace edgeslam {

constexpr const char* faulty_camera_device = "/dev/video-of-a-test";
constexpr int faulty_camera_width = 320, faulty_camera_height = 240;

// By the environment of the program:
// File: grey images, one after the other; or JPEG images, of which any is shorter than two grey ones.
constexpr const char* faulty_camera_frames = "EDGESLAM_CAMERA_FRAMES";
// File that, while it is there, names in one word the trouble there is:
//   gone      it is not plugged in
//   frozen    no frame comes
//   size      it breaks off, and offers another size only
//   short     half of each frame is missing
//   past      time stamps 3 s before
//   repeated  the same image again and again, with new time stamps
//   twice     each frame comes a second time
//   swapped   of two frames the second comes first
//   bursts    six frames come at once
// The picture goes on behind each of them: afterwards the camera is elsewhere.
constexpr const char* faulty_camera_trouble = "EDGESLAM_CAMERA_TROUBLE";

}  // namespace edgeslam
