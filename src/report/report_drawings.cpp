#include "report/report_drawings.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "image_formats/jpeg.h"

namespace edgeslam {

using nlohmann::ordered_json;

namespace {

constexpr std::size_t most_drawings = 24;
constexpr int widest_drawing = 800;  // [px]
constexpr int jpeg_quality = 82;

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned int group = 0;
    for (std::size_t j = 0; j < 3; ++j) group = (group << 8U) | (j < count ? bytes[i + j] : 0U);
    for (std::size_t j = 0; j < 4; ++j) text += j <= count ? digits[(group >> (18U - 6U * j)) & 63U] : '=';
  }
  return text;
}

}  // namespace

ordered_json drawingsJson(const RunResult& result, const Clock& clock) {
  ordered_json drawings = ordered_json::array();
  for (std::size_t i = 0; i < result.drawings.size(); i += strideFor(result.drawings.size(), most_drawings)) {
    cv::Mat image = result.drawings[i].image;
    if (image.empty() || image.depth() != CV_8U) continue;
    if (image.cols > widest_drawing) {
      const double scale = static_cast<double>(widest_drawing) / image.cols;
      cv::resize(result.drawings[i].image, image, cv::Size(), scale, scale, cv::INTER_AREA);
    }
    const std::vector<unsigned char> jpeg = encodeJpeg(image, jpeg_quality);
    const std::int64_t index = result.drawings[i].index;
    ordered_json drawing = {{"frame", index},
                            {"width", image.cols},
                            {"height", image.rows},
                            {"image", "data:image/jpeg;base64," + base64(jpeg)}};
    const auto record = std::find_if(result.frames.begin(), result.frames.end(),
                                     [index](const FrameRecord& frame) { return frame.index == index; });
    if (record != result.frames.end()) {
      drawing["time"] = clock(record->time_ns);
      drawing["state"] = stateName(record->state);
      drawing["reason"] = record->reason;
      drawing["tracked"] = record->tracked_points;
      drawing["mapped"] = record->mapped_points;
      drawing["keyframe"] = record->is_keyframe;
    }
    drawings.push_back(std::move(drawing));
  }
  return drawings;
}

}  // namespace edgeslam
