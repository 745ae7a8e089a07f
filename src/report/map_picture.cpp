#include "report/map_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "files/format_text.h"
#include "map/map_figures.h"
#include "map/worlds.h"

namespace edgeslam {
namespace {

constexpr int side = 900, border = 40;                   // of a world's square [px]
constexpr std::size_t most_beside = 4, most_drawn = 12;  // worlds in a row, and in all
const cv::Scalar white(255, 255, 255), grid_grey(225, 225, 225), dark(90, 90, 90), orange(0, 140, 255),
    blue(200, 80, 0), text_colour(40, 40, 40);

// 1, 2 or 5 times a power of ten: four to ten of them are in `extent`.
double squareFor(double extent) {
  const double power = std::pow(10, std::floor(std::log10(extent)));
  for (const double step : {0.1, 0.2, 0.5}) {
    if (extent / (step * power) <= 10) return step * power;
  }
  return power;
}

class WorldPicture {
 public:
  WorldPicture(cv::Mat picture, const WorldFigures& figures) : picture_(std::move(picture)) {
    const Eigen::Vector3d least = figures.cameras.least.cwiseMin(figures.most_points.least);
    const Eigen::Vector3d most = figures.cameras.most.cwiseMax(figures.most_points.most);
    centre_ = 0.5 * (least + most);
    extent_ = std::max({most.x() - least.x(), most.z() - least.z(), 1e-9});
  }

  void drawGrid(const std::string& name) {
    const double square = squareFor(extent_);
    const auto lines = static_cast<int>(std::ceil(extent_ / square)) + 1;
    for (int i = -lines; i <= lines; ++i) {
      const double x = (std::round(centre_.x() / square) + i) * square,
                   z = (std::round(centre_.z() / square) + i) * square;
      const cv::Point at = pixel({x, 0, z});
      cv::line(picture_, {at.x, 0}, {at.x, side - 1}, grid_grey);
      cv::line(picture_, {0, at.y}, {side - 1, at.y}, grid_grey);
    }
    cv::putText(picture_, name + formatted(": a square is %g map units", square), {12, 26}, cv::FONT_HERSHEY_SIMPLEX,
                0.6, text_colour, 1, cv::LINE_AA);
  }
  void drawPoint(const Eigen::Vector3d& position) { cv::circle(picture_, pixel(position), 1, dark, cv::FILLED); }
  void drawLine(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    cv::line(picture_, pixel(from), pixel(to), orange, 2, cv::LINE_AA);
  }
  void drawWay(const std::vector<Eigen::Vector3d>& positions) {
    for (std::size_t i = 1; i < positions.size(); ++i) {
      cv::line(picture_, pixel(positions[i - 1]), pixel(positions[i]), blue, 1, cv::LINE_AA);
    }
    for (const Eigen::Vector3d& position : positions)
      cv::circle(picture_, pixel(position), 3, blue, cv::FILLED, cv::LINE_AA);
    if (!positions.empty()) cv::circle(picture_, pixel(positions.front()), 7, blue, 2, cv::LINE_AA);
  }

 private:
  // What is far outside stays far outside.
  cv::Point pixel(const Eigen::Vector3d& position) const {
    const double scale = (side - 2 * border) / extent_;
    const auto bounded = [](double value) { return static_cast<int>(std::lround(std::clamp(value, -1e4, 1e4))); };
    return {bounded(0.5 * side + scale * (position.x() - centre_.x())),
            bounded(0.5 * side - scale * (position.z() - centre_.z()))};
  }

  cv::Mat picture_;  // a part of the whole
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double extent_ = 1;  // that fits [map units]
};

void drawWorld(const Map& map, const WorldFigures& figures, const cv::Mat& part) {
  WorldPicture picture(part, figures);
  picture.drawGrid("map " + std::to_string(figures.world));
  for (const auto& [id, point] : map.points) {
    if (map.keyframes[point.host].world == figures.world) picture.drawPoint(worldPosition(map, point));
  }
  for (const auto& [id, line] : map.lines) {
    if (!line.is_placed || map.keyframes[line.host].world != figures.world) continue;
    const SpaceLine in_world = inWorld(map, line);
    picture.drawLine(in_world.point + line.begin * in_world.direction, in_world.point + line.end * in_world.direction);
  }
  std::vector<Eigen::Vector3d> way;
  for (const KeyframeId id : keyframesOf(map, figures.world)) {
    way.push_back(map.keyframes[id].world_T_camera.translation);
  }
  picture.drawWay(way);
  cv::rectangle(part, {0, 0, side, side}, dark);
}

}  // namespace

cv::Mat drawMapFromAbove(const Map& map) {
  std::vector<WorldFigures> worlds = figuresOf(map);
  if (worlds.size() > most_drawn) {
    std::stable_sort(worlds.begin(), worlds.end(),
                     [](const WorldFigures& a, const WorldFigures& b) { return a.keyframes > b.keyframes; });
    worlds.resize(most_drawn);
  }
  const std::size_t columns = std::clamp<std::size_t>(worlds.size(), 1, most_beside);
  const std::size_t rows = std::max<std::size_t>(1, (worlds.size() + columns - 1) / columns);
  cv::Mat picture(static_cast<int>(rows) * side, static_cast<int>(columns) * side, CV_8UC3, white);
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    const auto column = static_cast<int>(i % columns), row = static_cast<int>(i / columns);
    drawWorld(map, worlds[i], picture(cv::Rect(column * side, row * side, side, side)));
  }
  return picture;
}

}  // namespace edgeslam
