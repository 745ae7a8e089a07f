// P19, eq. 1: bundle adjustment of keyframe poses, inverse depths and straight lines. A point is one unknown: its
// inverse distance rho along the fixed unit bearing in its host camera, X_host = bearing / rho. Residuals are whitened
// across and along the edge; a line is four unknowns, and what is seen of it has residuals across it. An inertial unit
// says how cameras turn and how their speed changes, wheels how they turn and how far they move.
// Levenberg-Marquardt's method minimises them with the depths and lines eliminated first, a depth by a division.
#pragma once

#include <array>
#include <atomic>
#include <vector>

#include "geometry/camera.h"
#include "geometry/measurement.h"
#include "geometry/pose.h"
#include "geometry/rolling_shutter.h"
#include "geometry/space_line.h"

namespace edgeslam {

using Matrix36d = Eigen::Matrix<double, 3, 6>;

struct BundleCamera {
  Pose world_T_camera;
  bool fixed = false;
  Twist twist = Twist::Zero();  // its motion while its rows are read; taken as it is
};

struct BundlePoint {
  int host = 0;                  // index of the host camera
  Eigen::Vector3d host_bearing;  // unit, host camera frame
  double inverse_depth = 1;
  bool fixed = false;
  double prior_sigma = 0;          // over 0: a prior on the inverse depth with this standard deviation ...
  double prior_inverse_depth = 1;  // ... around this value
  // Where the bearing starts from, host camera frame: not its centre where the host moved as it read the row.
  Eigen::Vector3d host_origin = Eigen::Vector3d::Zero();
};

struct BundleObservation {
  int camera = 0;  // not the point's host: the host's own view has no residual
  int point = 0;
  Measurement measurement;
};

struct BundleLine {
  SpaceLine line;  // world frame
  bool fixed = false;
};

// A ray on which a line is seen: two of them, to its ends, say all that a view of a straight edge does.
struct BundleLineObservation {
  int camera = 0;
  int line = 0;
  Eigen::Vector3d bearing;  // unit, camera frame of the row where it was measured
  double row = 0;           // that row [px]; matters where the camera moves while it is read
  double sigma = 0;         // standard deviation across the line [rad]
};

// From so many times BundleOptions::huber on what an inertial unit says counts linearly. Neighbouring terms share what
// was measured between them, and an unmodelled error of the unit lasts: a term that errs far says that a camera's pose
// is wrong as often as that the unit is, so that it is let go late.
constexpr double inertial_huber_times = 3;

// What an inertial unit, or wheels, say of two cameras: how the second is turned against the first.
struct BundleTurn {
  int first = 0, second = 0;  // cameras
  Eigen::Quaterniond first_R_second = Eigen::Quaterniond::Identity();
  Eigen::Matrix3d whitening = Eigen::Matrix3d::Identity();  // of the rotation vector's error, second camera's frame
  double huber_times = inertial_huber_times;
  // A bias of the gyroscope that is larger by b [rad/s] turns first_R_second on by exp(by_rate_bias b).
  Eigen::Matrix3d by_rate_bias = Eigen::Matrix3d::Zero();
};

// What it says of three cameras one after the other: how the mean speed between the last two differs from that between
// the first two. The unit's own speed, which nothing measures, has dropped out (mapping/inertial_terms.h).
struct BundleSpeedChange {
  std::array<int, 3> cameras{};
  std::array<double, 2> seconds{};                          // from each to the next one
  Eigen::Vector3d of_first = Eigen::Vector3d::Zero();       // without gravity, first camera's frame [m/s]
  Eigen::Vector3d of_second = Eigen::Vector3d::Zero();      // likewise, second camera's frame [m/s]
  Eigen::Matrix3d whitening = Eigen::Matrix3d::Identity();  // of the error [s/m], first camera's frame
  // How these change with the bias [rate [rad/s]; force [m/s^2]].
  Matrix36d first_by_bias = Matrix36d::Zero(), second_by_bias = Matrix36d::Zero();
};

// What wheels say of two cameras: where the second is, as the first one sees it. By their own metre, which holds the
// unit of the map; how long that is by inertia is not theirs to say.
struct BundleWay {
  int first = 0, second = 0;                                // cameras
  Eigen::Vector3d way = Eigen::Vector3d::Zero();            // first camera's frame [m]
  Eigen::Matrix3d whitening = Eigen::Matrix3d::Identity();  // of the error [1/m], first camera's frame
  double huber_times = inertial_huber_times;
  double metres_a_unit = 1;  // of the map, by the wheels
};

// What inertia counts with.
struct BundleInertia {
  double metres_a_unit = 1;                                // of the map
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();       // world frame [m/s^2]
  Eigen::Vector3d camera_t_imu = Eigen::Vector3d::Zero();  // place of the unit in the camera's frame [m]
  // Scale, gravity's direction and the biases are adjusted, too; the biases from no change, with these deviations.
  bool is_free = false;
  Vector6d bias_change = Vector6d::Zero();  // [rate [rad/s]; force [m/s^2]]
  double rate_bias_sigma = 0, force_bias_sigma = 0;
  // Of the scale, where something else tells it: its standard deviation, share of it. 0: nothing does.
  double told_metres_a_unit = 1, told_scale_sigma = 0;
};

// Of what is adjusted of inertia: logarithm of the scale, two tilts of gravity [rad], the biases' change.
using InertiaVector = Eigen::Matrix<double, 9, 1>;
using InertiaMatrix = Eigen::Matrix<double, 9, 9>;

struct BundleProblem {
  std::vector<BundleCamera> cameras;
  std::vector<BundlePoint> points;
  std::vector<BundleObservation> observations;
  std::vector<BundleLine> lines;
  std::vector<BundleLineObservation> line_observations;
  BundleInertia inertia;
  std::vector<BundleTurn> turns;
  std::vector<BundleSpeedChange> speed_changes;
  std::vector<BundleWay> ways;
  // Where over 0: the distance of this camera's centre from camera 0's is kept (the gauge of scale when only camera 0
  // is fixed), by scaling all centres and lines about camera 0 and all depths. Ignored where another camera, a point or
  // a line is fixed, as that holds the scale. Speed changes and ways then tell how the scale differs from place to
  // place.
  int scale_camera = -1;
  // Where the median of these says otherwise, their distances are kept: a scale camera that only now finds its place
  // would scale all others.
  std::vector<int> scale_cameras;
};

struct BundleOptions {
  int iterations = 8;
  double huber = 2.0;  // whitened, of the norm of an observation's two residuals, of a line's one, of inertia's or the
                       // wheels' three
};

struct BundleResult {
  // Something was adjusted, a step could be computed and all of it is finite. Else the problem is as it was: also
  // where an index is out of range or a camera's pose not finite.
  bool usable = false;
  // Whitened residual norm of each observation afterwards; infinity behind the camera, and for what takes no part:
  // measurements and points with values that are not finite, sigmas or inverse depths not over 0.
  std::vector<double> errors;
  // Standard deviation of each point's inverse depth with the poses held, outliers down-weighed (0 where unobserved).
  std::vector<double> depth_sigmas;
  // Absolute whitened residual of each line observation afterwards; infinity where the line is seen end-on, and for
  // what takes no part: values that are not finite, directions and bearings that are not unit, sigmas not over 0.
  std::vector<double> line_errors;
  // Covariance of each line's change (4, as of movedLine()) from where it is afterwards, with the poses held, outliers
  // down-weighed. Variances are at most 1e6, for what is not determined; 0 where the line is unobserved.
  std::vector<Eigen::Matrix4d> line_covariances;
  // Of what was adjusted of inertia, with all else free; 0 where it was not.
  InertiaMatrix inertia_covariance = InertiaMatrix::Zero();
  double initial_cost = 0;
  double final_cost = 0;
  int iterations = 0;
};

// Optimises the problem in place. The same input gives the same output to the last bit (one thread, no clock).
// Observations that are behind their camera count as constants until the others bring them before it. Inverse depths
// stay over 0. Where `interrupted` is given and becomes true, the adjustment is given up: not usable.
BundleResult adjustBundle(const Camera& camera, BundleProblem& problem, const BundleOptions& options,
                          const std::atomic<bool>* interrupted = nullptr);

}  // namespace edgeslam
