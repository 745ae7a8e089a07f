#include "mapping/quality_factor.h"

#include <algorithm>
#include <cmath>

#include "geometry/squared.h"

namespace edgeslam {
namespace {

// Inverse of z: along the image of a straight line of space it changes linearly.
double inverseZ(const QualityPoint& p) { return p.inverse_depth / p.bearing.z(); }

bool hasDepth(const QualityPoint& p) { return p.inverse_depth > 0 && std::isfinite(p.inverse_depth); }

bool agree(double a, double b, double ratio) { return std::abs(a - b) <= ratio * std::max(std::abs(a), std::abs(b)); }

class Neighbourhood {
 public:
  explicit Neighbourhood(const QualityOptions& options)
      : squared_px_(squared(options.neighbour_px)),
        squared_chord_(squared(2 * std::sin(0.5 * options.neighbour_deg * M_PI / 180))) {}

  bool hasBoth(const QualityPoint& a, const QualityPoint& b) const {
    return (a.pixel - b.pixel).squaredNorm() <= squared_px_ && (a.bearing - b.bearing).squaredNorm() <= squared_chord_;
  }

 private:
  double squared_px_, squared_chord_;  // the chord is that between unit bearings
};

// Three successive points of a chain that lie on a straight line in the image.
bool isStraightPiece(const QualityPoint& a, const QualityPoint& b, const QualityPoint& c,
                     const Neighbourhood& neighbourhood, double straight_px) {
  if (a.chain < 0 || a.chain != b.chain || b.chain != c.chain) return false;
  const Eigen::Vector2d chord = c.pixel - a.pixel;
  const double length = chord.norm();
  if (length < 2 || !neighbourhood.hasBoth(a, b) || !neighbourhood.hasBoth(b, c)) return false;
  const double off = std::abs(chord.x() * (b.pixel - a.pixel).y() - chord.y() * (b.pixel - a.pixel).x()) / length;
  return off < straight_px;
}

bool keepsOrder(const QualityPoint& a, const QualityPoint& b, const QualityPoint& c, const QualityOptions& options) {
  if (!hasDepth(a) || !hasDepth(b) || !hasDepth(c)) return false;
  const double along = (b.pixel - a.pixel).norm() / ((b.pixel - a.pixel).norm() + (c.pixel - b.pixel).norm());
  const double on_chord = (1 - along) * inverseZ(a) + along * inverseZ(c);
  return agree(inverseZ(a), inverseZ(c), options.same_depth_ratio) &&
         agree(inverseZ(b), on_chord, options.straight_depth_ratio);
}

}  // namespace

QualityFactor qualityFactor(std::vector<QualityPoint> points, const QualityOptions& options) {
  std::stable_sort(points.begin(), points.end(), [](const QualityPoint& a, const QualityPoint& b) {
    return a.chain != b.chain ? a.chain < b.chain : a.order < b.order;
  });
  const Neighbourhood neighbourhood(options);
  QualityFactor quality;
  for (std::size_t i = 0; i + 2 < points.size(); ++i) {
    if (!isStraightPiece(points[i], points[i + 1], points[i + 2], neighbourhood, options.straight_px)) continue;
    ++quality.pieces;
    quality.kept += keepsOrder(points[i], points[i + 1], points[i + 2], options);
  }
  // Straight lines reconstruct as straight lines from any two poses; only where edges of different directions meet do
  // wrong poses tear the structure apart.
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size(); ++j) {
      if (!neighbourhood.hasBoth(points[i], points[j])) continue;
      if (points[i].chain == points[j].chain) continue;
      if (std::abs(points[i].normal.dot(points[j].normal)) > 0.85) continue;
      ++quality.pieces;
      quality.kept += hasDepth(points[i]) && hasDepth(points[j]) &&
                      agree(inverseZ(points[i]), inverseZ(points[j]), options.same_depth_ratio);
    }
  }
  return quality;
}

}  // namespace edgeslam
