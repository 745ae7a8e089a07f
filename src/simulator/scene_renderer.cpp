#include "simulator/scene_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "simulator/scene_visibility.h"

namespace edgeslam {
namespace {

constexpr int kTile = 16;  // side of a tile [px]
constexpr std::size_t tile_area = kTile * kTile;
constexpr int kBlock = 4 * kTile;  // rectangles are first chosen for blocks of tiles of this side [px]
constexpr int kRaysPerPose = 4;    // rays a pixel and pose where a tile shows more than one surface

using SeenPointers = std::vector<const SeenRectangle*>;

struct PixelOffset {
  float x = 0, y = 0;
};

// `count` offsets [px], evenly spread in x, in y and in order (a rank-1 lattice), with a tent two pixels wide as
// density; their mean is zero.
std::vector<PixelOffset> spreadOffsets(int count) {
  const auto tent = [](double share) {
    return static_cast<float>(share < 0.5 ? std::sqrt(2 * share) - 1 : 1 - std::sqrt(2 - 2 * share));
  };
  const auto generator = [count](double ratio) {
    int g = std::max(1, static_cast<int>(ratio * count + 0.5));
    while (std::gcd(g, count) != 1) ++g;
    return g;
  };
  const int gx = generator(0.618), gy = generator(0.276);
  std::vector<PixelOffset> offsets;
  for (int i = 0; i < count; ++i) {
    offsets.push_back({tent((i * gx % count + 0.5) / count), tent((i * gy % count + 0.5) / count)});
  }
  return offsets;
}

struct PixelArea {
  int x = 0, y = 0, width = 0, height = 0;  // [px]
};

// The square from (x, y) on, as far as it lies inside `area`.
PixelArea squareIn(const PixelArea& area, int x, int y, int side) {
  return {x, y, std::min(side, area.x + area.width - x), std::min(side, area.y + area.height - y)};
}

std::size_t tableIndex(const RayTable& rays, int x, int y) {
  return static_cast<std::size_t>(y) * static_cast<std::size_t>(rays.width) + static_cast<std::size_t>(x);
}

// Box around the rays of an area and a pixel more on each side, which the offsets can reach.
RayBox boxAround(const RayTable& rays, const PixelArea& area) {
  float least_u = 1e9F, most_u = -1e9F, least_v = 1e9F, most_v = -1e9F;
  for (int y = area.y; y < area.y + area.height; ++y) {
    for (int x = area.x; x < area.x + area.width; ++x) {
      const std::size_t i = tableIndex(rays, x, y);
      const float reach_u = std::abs(rays.u_by_x[i]) + std::abs(rays.u_by_y[i]);
      const float reach_v = std::abs(rays.v_by_x[i]) + std::abs(rays.v_by_y[i]);
      least_u = std::min(least_u, rays.u[i] - reach_u), most_u = std::max(most_u, rays.u[i] + reach_u);
      least_v = std::min(least_v, rays.v[i] - reach_v), most_v = std::max(most_v, rays.v[i] + reach_v);
    }
  }
  return {(least_u + most_u) / 2, (least_v + most_v) / 2, (most_u - least_u) / 2, (most_v - least_v) / 2};
}

// The rays of one tile at an offset within the pixel, and what they saw in sum.
struct Tile {
  std::size_t count = 0;  // of pixels
  RayBox box;
  float pixel_u = 0;  // size of a pixel at unit depth
  std::array<float, tile_area> centre_u, centre_v, u_by_x, u_by_y, v_by_x, v_by_y;
  std::array<float, tile_area> u, v;
  std::array<float, tile_area> sum;
};

void loadTile(Tile& tile, const RayTable& rays, const PixelArea& area) {
  tile.count = 0;
  for (int y = area.y; y < area.y + area.height; ++y) {
    for (int x = area.x; x < area.x + area.width; ++x, ++tile.count) {
      const std::size_t from = tableIndex(rays, x, y), to = tile.count;
      tile.centre_u[to] = rays.u[from], tile.centre_v[to] = rays.v[from];
      tile.u_by_x[to] = rays.u_by_x[from], tile.u_by_y[to] = rays.u_by_y[from];
      tile.v_by_x[to] = rays.v_by_x[from], tile.v_by_y[to] = rays.v_by_y[from];
    }
  }
  tile.box = boxAround(rays, area);
  tile.pixel_u = tile.u_by_x[tile.count / 2];
  tile.sum.fill(0);
}

void moveRays(Tile& tile, const PixelOffset& offset) {
  for (std::size_t i = 0; i < tile.count; ++i) {
    tile.u[i] = tile.centre_u[i] + tile.u_by_x[i] * offset.x + tile.u_by_y[i] * offset.y;
    tile.v[i] = tile.centre_v[i] + tile.v_by_x[i] * offset.x + tile.v_by_y[i] * offset.y;
  }
}

// Where every ray hits the same rectangle.
void addSurface(Tile& tile, const SeenRectangle& seen, const Surface& surface) {
  for (std::size_t i = 0; i < tile.count; ++i) {
    const float u = tile.u[i], v = tile.v[i], depth = 1 / seen.inverse_depth(u, v);
    tile.sum[i] += shade(surface, depth * seen.s(u, v), depth * seen.t(u, v));
  }
}

void addNearest(Tile& tile, const SeenPointers& seen, const std::vector<Surface>& surfaces) {
  std::array<float, tile_area> nearest;
  std::array<int, tile_area> winner;
  nearest.fill(0);
  winner.fill(-1);
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const SeenRectangle r = *seen[k];
    const int number = static_cast<int>(k);
    for (std::size_t i = 0; i < tile.count; ++i) {
      const float u = tile.u[i], v = tile.v[i];
      const float s = r.s(u, v), t = r.t(u, v), inverse_depth = r.inverse_depth(u, v);
      // One number that is negative where the ray misses, so that the loop has no branches.
      const float inside = std::min(std::min(s, t), std::min(inverse_depth - s, inverse_depth - t));
      const bool hit = (inside >= 0) & (inverse_depth > nearest[i]);
      nearest[i] = hit ? inverse_depth : nearest[i];
      winner[i] = hit ? number : winner[i];
    }
  }
  for (std::size_t i = 0; i < tile.count; ++i) {
    if (winner[i] < 0) continue;
    const std::size_t k = static_cast<std::size_t>(winner[i]);
    const float u = tile.u[i], v = tile.v[i], depth = 1 / nearest[i];
    tile.sum[i] += shade(surfaces[k], depth * seen[k]->s(u, v), depth * seen[k]->t(u, v));
  }
}

// `seen` holds what may be seen in the tile at each pose. Returns the number of rays that went into each pixel's sum.
int renderTile(Tile& tile, const LitScene& lit, const std::vector<SeenPointers>& seen) {
  const int poses = static_cast<int>(seen.size());
  const auto surface = [&](const SeenRectangle& r) {
    const float depth = 1 / std::max(1e-3F, r.inverse_depth(tile.box.u, tile.box.v));
    return surfaceOf(lit, r.index, tile.pixel_u * depth);
  };
  std::vector<SeenPointers> first_hits(seen.size());
  bool single = true;
  for (std::size_t k = 0; k < seen.size(); ++k) {
    const bool alone = findFirstHits(seen[k], tile.box, first_hits[k]);
    single = single && alone && first_hits[k].front()->index == first_hits.front().front()->index;
  }
  if (single && surface(*first_hits.front().front()).texels == nullptr) {
    // Light alone varies so slowly that neither motion nor the lens shows.
    const SeenRectangle& middle = *first_hits[first_hits.size() / 2].front();
    moveRays(tile, {0, 0});
    addSurface(tile, middle, surface(middle));
    return 1;
  }
  const int rays_per_pose = single ? 1 : kRaysPerPose;
  const std::vector<PixelOffset> offsets = spreadOffsets(poses * rays_per_pose);
  std::vector<Surface> surfaces;
  for (int k = 0; k < poses; ++k) {
    const SeenPointers& hits = first_hits[static_cast<std::size_t>(k)];
    surfaces.clear();
    for (const SeenRectangle* r : hits) surfaces.push_back(surface(*r));
    for (int ray = 0; ray < rays_per_pose; ++ray) {
      moveRays(tile, offsets[static_cast<std::size_t>(ray * poses + k)]);
      if (single) {
        addSurface(tile, *hits.front(), surfaces.front());
      } else {
        addNearest(tile, hits, surfaces);
      }
    }
  }
  return poses * rays_per_pose;
}

// Writes the part of `radiance` that is in `area`.
void renderArea(const LitScene& lit, const RayTable& rays, const std::vector<Pose>& world_T_camera,
                const PixelArea& area, cv::Mat& radiance) {
  std::vector<std::vector<SeenRectangle>> seen;
  std::vector<SeenPointers> all(world_T_camera.size()), in_block(world_T_camera.size());
  seen.reserve(world_T_camera.size());
  for (std::size_t k = 0; k < world_T_camera.size(); ++k) {
    seen.push_back(seenFrom(lit.scene, world_T_camera[k]));
    for (const SeenRectangle& r : seen.back()) all[k].push_back(&r);
  }
  Tile tile;
  for (int block_y = area.y; block_y < area.y + area.height; block_y += kBlock) {
    for (int block_x = area.x; block_x < area.x + area.width; block_x += kBlock) {
      const PixelArea block = squareIn(area, block_x, block_y, kBlock);
      const RayBox block_box = boxAround(rays, block);
      for (std::size_t k = 0; k < all.size(); ++k) findFirstHits(all[k], block_box, in_block[k]);
      for (int y = block.y; y < block.y + block.height; y += kTile) {
        for (int x = block.x; x < block.x + block.width; x += kTile) {
          const PixelArea pixels = squareIn(block, x, y, kTile);
          loadTile(tile, rays, pixels);
          const float weight = 1.0F / static_cast<float>(renderTile(tile, lit, in_block));
          for (int row = 0; row < pixels.height; ++row) {
            const float* from = tile.sum.data() + static_cast<std::ptrdiff_t>(row) * pixels.width;
            std::transform(from, from + pixels.width, radiance.ptr<float>(y + row) + x,
                           [weight](float sum) { return weight * sum; });
          }
        }
      }
    }
  }
}

}  // namespace

cv::Mat renderRadiance(const LitScene& lit, const RayTable& rays, const std::vector<Pose>& world_T_camera) {
  cv::Mat radiance(rays.height, rays.width, CV_32F);
  renderArea(lit, rays, world_T_camera, {0, 0, rays.width, rays.height}, radiance);
  return radiance;
}

cv::Mat renderRowByRow(const LitScene& lit, const RayTable& rays,
                       const std::function<std::vector<Pose>(int row)>& world_T_camera) {
  cv::Mat radiance(rays.height, rays.width, CV_32F);
  for (int row = 0; row < rays.height; ++row) {
    renderArea(lit, rays, world_T_camera(row), {0, row, rays.width, 1}, radiance);
  }
  return radiance;
}

double meterRadiance(const LitScene& lit, const RayTable& rays, const Pose& world_T_camera) {
  constexpr int columns = 20, rows = 15;
  const std::vector<SeenRectangle> seen = seenFrom(lit.scene, world_T_camera);
  double sum = 0;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const std::size_t i =
          tableIndex(rays, (2 * column + 1) * rays.width / (2 * columns), (2 * row + 1) * rays.height / (2 * rows));
      const float u = rays.u[i], v = rays.v[i];
      const SeenRectangle* hit = firstHit(seen, u, v);
      if (!hit) continue;
      const float depth = 1 / hit->inverse_depth(u, v);
      // The meter blurs: a texture level as coarse as its own grid, or nearly.
      const Surface surface = surfaceOf(lit, hit->index, 10 * rays.u_by_x[i] * depth);
      sum += static_cast<double>(shade(surface, depth * hit->s(u, v), depth * hit->t(u, v)));
    }
  }
  return sum / (columns * rows);
}

}  // namespace edgeslam
