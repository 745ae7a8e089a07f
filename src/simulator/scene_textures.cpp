#include "simulator/scene_textures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <random>

namespace edgeslam {
namespace {

// std::uniform_int_distribution differs between libraries; this does not.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : generator_(seed) {}
  int between(int least, int most) {
    return least + static_cast<int>(generator_() % static_cast<std::uint64_t>(most - least + 1));
  }

 private:
  std::mt19937_64 generator_;
};

SceneTexture withLevels(cv::Mat drawing) {
  cv::flip(drawing, drawing, 0);  // row 0 is t = 0, the bottom
  SceneTexture texture;
  texture.levels.push_back(drawing);
  while (std::min(drawing.cols, drawing.rows) >= 8) {
    cv::Mat half;
    cv::resize(drawing, half, cv::Size(drawing.cols / 2, drawing.rows / 2), 0, 0, cv::INTER_AREA);
    texture.levels.push_back(half);
    drawing = half;
  }
  return texture;
}

// Smooth noise: random values on coarser and coarser grids, interpolated and summed. CV_32F, roughly in [-1, 1].
cv::Mat smoothNoise(int width, int height, int finest, int coarsest, Dice& dice) {
  cv::Mat sum = cv::Mat::zeros(height, width, CV_32F);
  float weight = 1, total = 0;
  for (int cell = coarsest; cell >= finest; cell /= 2, weight *= 0.7F) {
    cv::Mat grid(height / cell + 2, width / cell + 2, CV_32F), fine;
    for (auto it = grid.begin<float>(); it != grid.end<float>(); ++it)
      *it = static_cast<float>(dice.between(-1000, 1000)) / 1000;
    cv::resize(grid, fine, cv::Size(width, height), 0, 0, cv::INTER_LINEAR);
    sum += weight * fine;
    total += weight;
  }
  return sum / total;
}

void drawPhotograph(cv::Mat area, Dice& dice) {
  const cv::Mat noise = smoothNoise(area.cols, area.rows, 6, 48, dice);
  const cv::Mat grey = noise * 150 + dice.between(80, 150);
  grey.convertTo(area, CV_8U);
}

void drawPrint(cv::Mat area, Dice& dice) {
  area.setTo(dice.between(215, 250));
  for (int y = 8; y + 8 < area.rows; y += 14) {
    int x = 8;
    const int end = area.cols - 8 - dice.between(0, area.cols / 4);
    while (x < end) {
      const int word = dice.between(8, 34);
      cv::rectangle(area, cv::Rect(x, y, std::min(word, std::max(1, end - x)), 6), dice.between(20, 70), cv::FILLED);
      x += word + 6;
    }
  }
}

void drawBars(cv::Mat area, Dice& dice) {
  area.setTo(dice.between(180, 240));
  const int bars = dice.between(4, 8), step = std::max(4, area.cols / (bars + 1));
  for (int i = 0; i < bars; ++i) {
    const int height = dice.between(area.rows / 6, area.rows * 9 / 10);
    cv::rectangle(area, cv::Rect(step / 2 + i * step, area.rows - height, std::max(2, step * 2 / 3), height),
                  dice.between(20, 150), cv::FILLED);
  }
}

void drawShapes(cv::Mat area, int count, Dice& dice) {
  const int largest = std::max(12, std::min(area.cols, area.rows) / 5);
  for (int i = 0; i < count; ++i) {
    const cv::Point centre(dice.between(0, area.cols - 1), dice.between(0, area.rows - 1));
    const int size = dice.between(largest / 4, largest), grey = dice.between(15, 245);
    switch (dice.between(0, 3)) {
      case 0:
        cv::circle(area, centre, size / 2, grey, cv::FILLED, cv::LINE_AA);
        break;
      case 1:
        cv::circle(area, centre, size / 2, grey, std::max(3, size / 8), cv::LINE_AA);
        break;
      default: {
        const int corners = dice.between(3, 5), turn = dice.between(0, 359);
        std::vector<cv::Point> polygon;
        for (int corner = 0; corner < corners; ++corner) {
          const double angle = (turn + 360.0 * corner / corners) * CV_PI / 180;
          polygon.emplace_back(centre.x + cvRound(size * 0.7 * std::cos(angle)),
                               centre.y + cvRound(size * 0.7 * std::sin(angle)));
        }
        cv::fillConvexPoly(area, polygon, grey, cv::LINE_AA);
      }
    }
  }
}

}  // namespace

SceneTexture drawPoster(int width, int height, std::uint64_t seed) {
  Dice dice(seed);
  cv::Mat poster(height, width, CV_8U, cv::Scalar(dice.between(60, 235)));
  const int margin = std::max(4, width / 24);
  // The poster is cut into fields; each gets its own kind of drawing.
  const int columns = dice.between(1, 2), rows = dice.between(2, 3);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const cv::Rect field(margin + column * (width - margin) / columns, margin + row * (height - margin) / rows,
                           (width - margin) / columns - margin, (height - margin) / rows - margin);
      cv::Mat area = poster(field);
      switch (dice.between(0, 3)) {
        case 0:
          drawPhotograph(area, dice);
          break;
        case 1:
          drawPrint(area, dice);
          break;
        case 2:
          drawBars(area, dice);
          break;
        default:
          drawShapes(area, 14, dice);
      }
    }
  }
  drawShapes(poster, 6, dice);
  return withLevels(poster);
}

SceneTexture drawCarpet(int width, int height, double contrast, std::uint64_t seed) {
  Dice dice(seed);
  const cv::Mat grey = smoothNoise(width, height, 2, 32, dice) * (255 * contrast * 3.5) + 215;
  cv::Mat carpet;
  grey.convertTo(carpet, CV_8U);
  return withLevels(carpet);
}

SceneTexture drawTiles(int width, int height, int tile, std::uint64_t seed) {
  Dice dice(seed);
  const int joint = std::max(1, tile / 40);
  cv::Mat floor(height, width, CV_8U, cv::Scalar(90));
  for (int y = 0; y < height; y += tile) {
    for (int x = 0; x < width; x += tile) {
      const cv::Rect inside(x + joint, y + joint, tile - 2 * joint, tile - 2 * joint);
      floor(inside & cv::Rect(0, 0, width, height)).setTo(cv::Scalar(dice.between(185, 245)));
    }
  }
  return withLevels(floor);
}

SceneTexture drawDoorLeaf(int width, int height, std::uint64_t seed) {
  Dice dice(seed);
  cv::Mat leaf(height, width, CV_8U);
  const cv::Mat grain = smoothNoise(width, 8, 2, 8, dice) * 14 + 225;
  cv::Mat stretched;
  cv::resize(grain, stretched, leaf.size(), 0, 0, cv::INTER_LINEAR);
  stretched.convertTo(leaf, CV_8U);
  const int inset = width / 6;
  for (const int top : {inset, height * 6 / 10}) {
    const int bottom = top == inset ? height * 6 / 10 - inset / 2 : height - inset;
    cv::rectangle(leaf, cv::Point(inset, top), cv::Point(width - inset, bottom), 150, std::max(1, width / 50));
  }
  return withLevels(leaf);
}

}  // namespace edgeslam
