// What a recording of the flight recorder looks like on disk, for its writer and its reader. Unpacked it is a TUM RGB-D
// folder with some files more:
//   rgb.tar                       the frames' images, rgb/SECONDS.NANOSECONDS.pgm or .png, 8 bits of grey, lossless, or
//                                 .jpg, as the camera sent it
//   rgb.txt                       "time-stamp file" a line [s], only images that the disk has confirmed
//   camera.yaml                   the calibration, as readCalibration reads it
//   edgeslam.yaml                 the configuration of the run
//   mask.png                      where the camera's images were not looked at, where the run had a mask
//   map_at_start.map              the map that the run went on with, where there was one (map/map_file.h)
//   recording.txt                 versions of the layout and of the program; its presence makes the folder a recording
//   decisions.txt                 what the live run did with which frame, one line a decision, see Decision
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "frames/tum_folder.h"
#include "inertia/inertial_unit.h"
#include "recording/frame_archive.h"
#include "wheels/odometry_pose.h"

namespace edgeslam {

constexpr int recording_format_version = 4;  // 1 to 3 are read, too
constexpr int first_archive_format = 3;      // before, frames are files in rgb/, as PNG
constexpr const char* recording_description_name = "recording.txt";
constexpr const char* recording_decisions_name = "decisions.txt";
constexpr const char* recording_configuration_name = "edgeslam.yaml";
constexpr const char* recording_mask_name = "mask.png";
constexpr const char* recording_map_name = "map_at_start.map";

// The lines of decisions.txt, in the order in which the run took them:
enum class DecisionKind {
  frame,    // "frame INDEX TIME_NS OFFSET SIZE CHECKSUM": was processed; its image file is at byte OFFSET of rgb.tar,
            // and has SIZE bytes with this CRC-32 (8 hexadecimal digits)
  dropped,  // "dropped INDEX TIME_NS": was not processed, tracking being behind
  unreadable,  // "unreadable INDEX TIME_NS REASON"
  update,      // "update INDEX NUMBER": before processing frame INDEX, tracking took map update NUMBER
  inertia,     // "inertia INDEX TIME_NS RATE RATE RATE FORCE FORCE FORCE": before processing frame INDEX, tracking was
               // given what the inertial unit measured at TIME_NS of its clock [rad/s], [m/s^2]
  wheels,  // "wheels INDEX TIME_NS X Y Z W X Y Z": likewise, where the wheels said that the robot's body was [m], and
           // how it was turned, a unit quaternion
  busy,    // "busy INDEX": frame INDEX told mapping nothing, mapping being far behind
  correction,  // "correction MESSAGE NUMBER": before handling message MESSAGE, mapping applied correction NUMBER
  gap,         // "gap COUNT": here COUNT decisions or frames are missing, the run cannot be repeated from here on
  stopped,     // "stopped REASON": recording ended before the run did; the last line
  end          // "end": the run ended; the last line
};

struct Decision {
  DecisionKind kind = DecisionKind::frame;
  std::int64_t index = 0;    // of the frame, counted over all frames of the camera from 0; for a correction: MESSAGE
  std::int64_t time_ns = 0;  // frame, dropped, unreadable, inertia, wheels
  std::int64_t number = 0;   // update and correction: NUMBER; gap: COUNT
  std::string text;          // unreadable and stopped: why; frame, inertia and wheels: what else stands in the line
};

// The most that an image file of so many pixels may have [bytes]. A camera's JPEG is smaller by far, or it pads.
std::int64_t largestArchivedImage(int width, int height);

// Of kind `frame`.
Decision frameDecision(std::int64_t index, std::int64_t time_ns, const ArchivedImage& image);
// The other way; nothing where it is of another kind, or the text is not that.
std::optional<ArchivedImage> archivedImageOf(const Decision& decision);

// Of kind `inertia`. The numbers have all their digits.
Decision inertiaDecision(std::int64_t frame_index, const InertialSample& sample);
// The other way; nothing where the text is not six numbers, or they are nothing that a unit measures (isUsable()).
std::optional<InertialSample> inertialSampleOf(const Decision& decision);

// Likewise of kind `wheels`.
Decision wheelsDecision(std::int64_t frame_index, const OdometryPose& pose);
std::optional<OdometryPose> odometryPoseOf(const Decision& decision);

// The line with its line end. It ends in a blank and the CRC-32 (zlib's crc32, 8 hexadecimal digits) of what stands
// before, so that a line that was torn by a power cut is known. Control characters of `text` become blanks, and what is
// beyond 500 bytes of it is left out.
std::string formatDecision(const Decision& decision);

// What stands before the CRC; nothing where the line (without its line end) is torn or damaged.
std::optional<std::string_view> undamagedDecision(std::string_view line);

// Reads what undamagedDecision gave. Throws InputError, `place` before the message, for anything but such a line.
Decision parseDecision(std::string_view text, const std::string& place);

// The order in which decisions can follow each other: INDEX grows over all frames, TIME_NS over those not dropped;
// updates', inertia's and wheels' INDEX and corrections' MESSAGE never go back, their NUMBERs grow; an image lies
// behind the one before; nothing follows the last line. All values are 0 to 4e18.
class DecisionOrder {
 public:
  // Empty and remembers the decision, or says why it cannot come next.
  std::string add(const Decision& decision);

 private:
  bool ended_ = false;
  std::int64_t index_ = -1, time_ns_ = -1;
  std::int64_t archive_end_ = 0;  // of the last image [byte]
  std::int64_t update_index_ = 0, update_number_ = -1;
  std::int64_t inertia_index_ = 0, wheels_index_ = 0;
  std::int64_t busy_index_ = -1;
  std::int64_t correction_message_ = 0, correction_number_ = -1;
};

}  // namespace edgeslam
