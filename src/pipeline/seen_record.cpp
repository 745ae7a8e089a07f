#include "pipeline/seen_record.h"

#include <type_traits>

namespace edgeslam {

static_assert(std::is_trivially_copyable_v<PackedPoint>, "it is written as it lies in memory");

void SeenRecord::add(const SeenPoints& seen) {
  const std::size_t offset = file_.size();
  const bool is_kept =
      !seen.points.empty() && file_.append(seen.points.data(), seen.points.size() * sizeof(PackedPoint));
  kept_.push_back({offset, is_kept ? seen.points.size() : 0, seen.first, seen.pixel_step});
}

SeenPoints SeenRecord::of(std::size_t frame) {
  const Kept& kept = kept_[frame];
  SeenPoints seen{kept.first, kept.pixel_step, std::vector<PackedPoint>(kept.points)};
  if (!file_.read(kept.offset, seen.points.data(), kept.points * sizeof(PackedPoint))) seen.points.clear();
  return seen;
}

}  // namespace edgeslam
