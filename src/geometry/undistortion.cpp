#include "geometry/undistortion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/distortion_reach.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "geometry/undistortion.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

// Newton's method as in camera.cpp, operation for operation; a lane that has converged keeps its value until all have.
// Compiled without fused multiplications, so that the bits are those of plain code.

HWY_BEFORE_NAMESPACE();
namespace edgeslam {
namespace HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR || !HWY_HAVE_FLOAT64

void bearingsByVectors(const Camera& camera, const Eigen::Vector2d* pixels, std::size_t count,
                       Eigen::Vector3d* bearings) {
  bearingsReference(camera, pixels, count, bearings);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using Vector = hn::Vec<Doubles>;
using Mask = hn::Mask<Doubles>;

constexpr int most_iterations = 20;

Vector set(double value) { return hn::Set(Doubles(), value); }
Mask isFinite(Vector value) { return hn::Le(hn::Abs(value), set(std::numeric_limits<double>::max())); }

// Undistorts normalized coordinates in place.
void undistortRadialTangential(const Camera& camera, Vector& u, Vector& v) {
  using hn::Add;
  using hn::Mul;
  using hn::Sub;
  const std::array<double, 5>& k = camera.distortion;
  const DistortionTangent tangent = distortionTangent(camera);
  const Vector reach_squared = set(camera.distortion_reach * camera.distortion_reach);
  const double k1 = k[0], k2 = k[1], p1 = k[2], p2 = k[3], k3 = k[4];
  const Vector distorted_x = u, distorted_y = v;
  Mask active = isFinite(set(0));
  for (int i = 0; i < most_iterations; ++i) {
    const Vector x = u, y = v;
    const Vector twice_x = Add(x, x), twice_y = Add(y, y);
    const Vector r2 = Add(Mul(x, x), Mul(y, y));
    Vector radial = Add(set(1), Mul(r2, Add(set(k1), Mul(r2, Add(set(k2), Mul(r2, set(k3)))))));
    Vector radial_r2 = Add(set(k1), Mul(r2, Add(set(2 * k2), Mul(set(3 * k3), r2))));
    const Mask beyond = hn::Gt(r2, reach_squared);
    if (!hn::AllFalse(Doubles(), beyond)) {
      const Vector r = hn::Sqrt(r2);
      radial = hn::IfThenElse(beyond, Add(set(tangent.slope), hn::Div(set(tangent.offset), r)), radial);
      radial_r2 = hn::IfThenElse(beyond, hn::Div(set(-0.5 * tangent.offset), Mul(r2, r)), radial_r2);
    }
    const Vector xx = Add(Add(Add(radial, Mul(Mul(twice_x, x), radial_r2)), Mul(set(2 * p1), y)), Mul(set(6 * p2), x));
    const Vector xy = Add(Add(Mul(Mul(twice_x, y), radial_r2), Mul(set(2 * p1), x)), Mul(set(2 * p2), y));
    const Vector yy = Add(Add(Add(radial, Mul(Mul(twice_y, y), radial_r2)), Mul(set(6 * p1), y)), Mul(set(2 * p2), x));
    const Vector made_x = Add(Add(Mul(x, radial), Mul(Mul(set(2 * p1), x), y)), Mul(set(p2), Add(r2, Mul(twice_x, x))));
    const Vector made_y = Add(Add(Mul(y, radial), Mul(set(p1), Add(r2, Mul(twice_y, y)))), Mul(Mul(set(2 * p2), x), y));
    const Vector error_x = Sub(made_x, distorted_x), error_y = Sub(made_y, distorted_y);
    const Vector inverse_determinant = hn::Div(set(1), Sub(Mul(xx, yy), Mul(xy, xy)));
    const Vector across = Mul(hn::Neg(xy), inverse_determinant);
    const Vector step_x = Add(Mul(Mul(yy, inverse_determinant), error_x), Mul(across, error_y));
    const Vector step_y = Add(Mul(across, error_x), Mul(Mul(xx, inverse_determinant), error_y));
    active = hn::And(active, hn::And(isFinite(step_x), isFinite(step_y)));
    u = hn::IfThenElse(active, Sub(x, step_x), x);
    v = hn::IfThenElse(active, Sub(y, step_y), y);
    const Vector squared = Add(Mul(step_x, step_x), Mul(step_y, step_y));
    active = hn::And(active, hn::Ge(squared, set(1e-24)));
    if (hn::AllFalse(Doubles(), active)) break;
  }
}

// The angle from the optical axis of a distorted one [rad].
Vector undistortAngle(const Camera& camera, Vector distorted) {
  using hn::Add;
  using hn::Mul;
  const std::array<double, 5>& k = camera.distortion;
  const DistortionTangent tangent = distortionTangent(camera);
  Vector theta = distorted;
  Mask active = isFinite(set(0));
  for (int i = 0; i < most_iterations; ++i) {
    const Vector t2 = Mul(theta, theta);
    const Vector inner = Add(set(7 * k[2]), Mul(Mul(t2, set(9)), set(k[3])));
    Vector derivative = Add(set(1), Mul(t2, Add(set(3 * k[0]), Mul(t2, Add(set(5 * k[1]), Mul(t2, inner))))));
    const Vector polynomial = Add(set(k[1]), Mul(t2, Add(set(k[2]), Mul(t2, set(k[3])))));
    Vector made = Mul(theta, Add(set(1), Mul(t2, Add(set(k[0]), Mul(t2, polynomial)))));
    const Mask beyond = hn::Gt(theta, set(camera.distortion_reach));
    derivative = hn::IfThenElse(beyond, set(tangent.slope), derivative);
    made = hn::IfThenElse(beyond, Add(set(tangent.offset), Mul(set(tangent.slope), theta)), made);
    const Vector step = hn::Div(hn::Sub(made, distorted), derivative);
    active = hn::And(active, isFinite(step));
    theta = hn::IfThenElse(active, hn::Sub(theta, step), theta);
    active = hn::And(active, hn::Ge(hn::Abs(step), set(1e-12)));
    if (hn::AllFalse(Doubles(), active)) break;
  }
  return theta;
}

// Of a vector of normalized distorted coordinates: 3 values each.
void pinholeBearings(const Camera& camera, Vector x, Vector y, double* HWY_RESTRICT bearings) {
  undistortRadialTangential(camera, x, y);
  const Vector squared = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), set(1));
  const Vector norm = hn::Sqrt(squared);
  hn::StoreInterleaved3(hn::Div(x, norm), hn::Div(y, norm), hn::Div(set(1), norm), Doubles(), bearings);
}

void fisheyeBearings(const Camera& camera, Vector x, Vector y, double* HWY_RESTRICT bearings) {
  const Doubles d;
  HWY_ALIGN double angles[8], directions_x[8], directions_y[8];
  const Vector distorted = hn::Sqrt(hn::Add(hn::Mul(x, x), hn::Mul(y, y)));
  const Mask off_axis = hn::Ge(distorted, set(1e-12));
  hn::Store(hn::IfThenElseZero(off_axis, undistortAngle(camera, distorted)), d, angles);
  hn::Store(hn::IfThenElseZero(off_axis, hn::Div(x, distorted)), d, directions_x);
  hn::Store(hn::IfThenElseZero(off_axis, hn::Div(y, distorted)), d, directions_y);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    bearings[3 * i] = std::sin(angles[i]) * directions_x[i];
    bearings[3 * i + 1] = std::sin(angles[i]) * directions_y[i];
    bearings[3 * i + 2] = std::cos(angles[i]);
  }
}

void bearingsByVectors(const Camera& camera, const Eigen::Vector2d* pixels, std::size_t count,
                       Eigen::Vector3d* bearings) {
  const Doubles d;
  HWY_ALIGN double read[2 * 8], made[3 * 8];
  for (std::size_t first = 0; first < count; first += hn::Lanes(d)) {
    const std::size_t here = std::min(hn::Lanes(d), count - first);
    for (std::size_t i = 0; i < hn::Lanes(d); ++i) {  // the last one goes on
      const Eigen::Vector2d& pixel = pixels[first + std::min(i, here - 1)];
      read[2 * i] = pixel.x();
      read[2 * i + 1] = pixel.y();
    }
    Vector x, y;
    hn::LoadInterleaved2(d, read, x, y);
    x = hn::Div(hn::Sub(x, set(camera.cx)), set(camera.fx));
    y = hn::Div(hn::Sub(y, set(camera.cy)), set(camera.fy));
    if (camera.model == CameraModel::kannala_brandt) {
      fisheyeBearings(camera, x, y, made);
    } else {
      pinholeBearings(camera, x, y, made);
    }
    for (std::size_t i = 0; i < here; ++i) bearings[first + i] = {made[3 * i], made[3 * i + 1], made[3 * i + 2]};
  }
}

#endif

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace edgeslam
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace edgeslam {

HWY_EXPORT(bearingsByVectors);

void bearingsOf(const Camera& camera, const Eigen::Vector2d* pixels, std::size_t count, Eigen::Vector3d* bearings) {
  HWY_DYNAMIC_DISPATCH(bearingsByVectors)(camera, pixels, count, bearings);
}

void bearingsReference(const Camera& camera, const Eigen::Vector2d* pixels, std::size_t count,
                       Eigen::Vector3d* bearings) {
  for (std::size_t i = 0; i < count; ++i) bearings[i] = bearing(camera, pixels[i]);
}

}  // namespace edgeslam
#endif
