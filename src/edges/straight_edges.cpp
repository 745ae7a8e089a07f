#include "edges/straight_edges.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <iterator>

namespace edgeslam {
namespace {

constexpr int sample_step = 2;  // of a chain's points

struct Sample {
  int point = 0;  // of EdgeMap::points
  Eigen::Vector3d bearing;
};

struct Piece {
  std::size_t first = 0, last = 0;  // samples
};

class ChainPieces {
 public:
  ChainPieces(const Camera& camera, const StraightEdgeOptions& options, std::pmr::memory_resource* memory)
      : options_(options), camera_(camera), focal_length_(meanFocalLength(camera)), samples_(memory), pieces_(memory) {}

  void add(const EdgeMap& edges, int begin, int end, StraightEdges& found) {
    if (end - begin < static_cast<int>(options_.least_length)) return;
    samples_.clear();
    for (int i = begin; i < end; i += sample_step) {
      samples_.push_back({i, bearing(camera_, edges.points[static_cast<std::size_t>(i)].pixel.cast<double>())});
    }
    pieces_.clear();
    split({0, samples_.size() - 1});
    for (const Piece& piece : pieces_) addStraight(piece, found);
  }

 private:
  // Halved at the sample farthest from the plane through its ends, until all are near it (Douglas and Peucker, 1973).
  void split(Piece piece) {
    if (static_cast<double>((piece.last - piece.first) * sample_step) < options_.least_length) return;
    if (length(piece) < options_.least_length) {
      splitWhereItTurnsBack(piece);
      return;
    }
    const Eigen::Vector3d normal = planeThrough(samples_[piece.first].bearing, samples_[piece.last].bearing);
    std::size_t farthest = piece.first;
    double largest = options_.largest_offset / focal_length_;
    for (std::size_t i = piece.first + 1; i < piece.last; ++i) {
      const double offset = std::abs(normal.dot(samples_[i].bearing));
      if (offset <= largest) continue;
      largest = offset;
      farthest = i;
    }
    if (farthest == piece.first) {
      pieces_.push_back(piece);
      return;
    }
    split({piece.first, farthest});
    split({farthest, piece.last});
  }

  // The ends of a closed chain are no line: halved at the sample farthest from its first one.
  void splitWhereItTurnsBack(Piece piece) {
    std::size_t farthest = piece.first + 1;
    for (std::size_t i = farthest; i < piece.last; ++i) {
      if (length({piece.first, i}) > length({piece.first, farthest})) farthest = i;
    }
    split({piece.first, farthest});
    split({farthest, piece.last});
  }

  void addStraight(Piece piece, StraightEdges& found) const {
    const auto margin = static_cast<std::size_t>(options_.end_margin / sample_step + 0.5);
    if (piece.last - piece.first < 2 * margin + 4) return;
    piece = {piece.first + margin, piece.last - margin};
    if (length(piece) < options_.least_length) return;
    Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
    for (std::size_t i = piece.first; i <= piece.last; ++i) {
      products += samples_[i].bearing * samples_[i].bearing.transpose();
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(products);
    const Eigen::Vector3d normal = solver.eigenvectors().col(0);
    const auto onLine = [&](std::size_t i) -> Eigen::Vector3d {
      const Eigen::Vector3d& b = samples_[i].bearing;
      return (b - normal.dot(b) * normal).normalized();
    };
    if (bend(piece, normal) > options_.largest_bend) return;
    StraightEdge edge;
    edge.from_bearing = onLine(piece.first);
    edge.to_bearing = onLine(piece.last);
    edge.from = project(camera_, edge.from_bearing);
    edge.to = project(camera_, edge.to_bearing);
    edge.first_point = samples_[piece.first].point;
    edge.end_point = samples_[piece.last].point + 1;
    found.push_back(edge);
  }

  // Height of the parabola over the piece that fits the offsets best [px].
  double bend(const Piece& piece, const Eigen::Vector3d& normal) const {
    const auto count = static_cast<double>(piece.last - piece.first);
    double fit = 0, norm = 0;
    for (std::size_t i = piece.first; i <= piece.last; ++i) {
      const double along = 2 * static_cast<double>(i - piece.first) / count - 1;
      const double parabola = 1.0 / 3 - along * along;
      fit += parabola * focal_length_ * normal.dot(samples_[i].bearing);
      norm += parabola * parabola;
    }
    return std::abs(fit / norm);
  }

  static Eigen::Vector3d planeThrough(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    const Eigen::Vector3d normal = a.cross(b);
    const double norm = normal.norm();
    return norm > 0 ? Eigen::Vector3d(normal / norm) : Eigen::Vector3d::Zero();
  }

  double length(const Piece& piece) const {
    return focal_length_ * (samples_[piece.last].bearing - samples_[piece.first].bearing).norm();
  }

  const StraightEdgeOptions& options_;
  const Camera& camera_;
  double focal_length_;
  std::pmr::vector<Sample> samples_;
  std::pmr::vector<Piece> pieces_;
};

}  // namespace

StraightEdges straightEdges(const Camera& camera, const EdgeMap& edges, const StraightEdgeOptions& options,
                            std::pmr::memory_resource* memory) {
  StraightEdges found(memory);
  if (!options.enabled) return found;
  ChainPieces pieces(camera, options, memory);
  const int count = static_cast<int>(edges.points.size());
  for (int begin = 0, end = 0; begin < count; begin = end) {
    const int chain = edges.points[static_cast<std::size_t>(begin)].chain;
    for (end = begin; end < count && edges.points[static_cast<std::size_t>(end)].chain == chain;) ++end;
    pieces.add(edges, begin, end, found);
  }
  return found;
}

int straightEdgeOf(const StraightEdges& straight, int edge_point, int margin) {
  const auto after = std::upper_bound(straight.begin(), straight.end(), edge_point,
                                      [](int point, const StraightEdge& edge) { return point < edge.first_point; });
  if (after == straight.begin()) return -1;
  const StraightEdge& edge = *std::prev(after);
  if (edge_point < edge.first_point + margin || edge_point >= edge.end_point - margin) return -1;
  return static_cast<int>(std::prev(after) - straight.begin());
}

}  // namespace edgeslam
