#include "configuration/configuration_keys.h"

#include <charconv>
#include <cmath>

namespace edgeslam {
namespace {

ConfigurationKey heading(const std::string& section, const std::string& documentation) {
  return {section, std::monostate{}, "", 0, 0, documentation};
}

}  // namespace

std::vector<ConfigurationKey> configurationKeys(Settings& settings) {
  EdgeOptions& edges = settings.tracking.edges;
  BlurGateOptions& blur_gate = settings.tracking.blur_gate;
  PointChoiceOptions& points = settings.tracking.points;
  FramePoseOptions& pose = settings.tracking.pose;
  FlowOptions& flow = settings.tracking.flow;
  RefinementOptions& refinement = settings.tracking.refinement;
  EdgeLockOptions& edge_lock = settings.tracking.edge_lock;
  MapReuseOptions& reuse = settings.tracking.map_reuse;
  ViewOptions& view = settings.mapping.view;
  KeyframeOptions& keyframes = settings.tracking.keyframes;
  TrackerOptions& tracking = settings.tracking;
  InitialisationOptions& initialisation = settings.mapping.initialisation;
  QualityOptions& quality = settings.mapping.initialisation.quality;
  NewPointOptions& new_points = settings.mapping.new_points;
  LocalAdjustmentOptions& adjustment = settings.mapping.local_adjustment;
  BundleOptions& bundle = settings.mapping.local_adjustment.bundle;
  CullingOptions& culling = settings.mapping.culling;
  ThreadOptions& threads = settings.threads;
  return {
      heading("edges", "Edges: zero crossings of a difference of Gaussians, joined into chains"),
      {"edges.sigma", &edges.sigma, "px", 0.3, 10, "standard deviation of the narrower Gaussian"},
      {"edges.sigma_ratio", &edges.sigma_ratio, "", 1.05, 4,
       "standard deviation of the wider Gaussian over the narrower's"},
      {"edges.plane_fit_radius", &edges.plane_fit_radius, "px", 1, 7,
       "a plane is fitted over (2 r + 1)^2 pixels of the difference"},
      {"edges.sign_balance", &edges.sign_balance, "", 0, 1, "most |positive - negative| / all signs in that window"},
      {"edges.gradient_threshold", &edges.gradient_threshold, "grey/px", 0, 100, "least gradient across an edge"},
      {"edges.shortest_chain", &edges.shortest_chain, "points", 1, 1000, "shorter chains are no edges"},

      heading("blur_gate", "Blurred frames: told by the sum of the gradients at the edge points"),
      {"blur_gate.share_of_average", &blur_gate.share_of_average, "", 0, 1,
       "less of the average sharpness is blurred; 0 lets all pass"},
      {"blur_gate.forgetting", &blur_gate.forgetting, "", 0, 0.9999, "weight of the past in the average, a frame"},
      {"blur_gate.longest_rejection", &blur_gate.longest_rejection, "frames", 1, 1000,
       "after as many in a row the average starts anew"},

      heading("points", "Choice of the points to track, and how exactly each is measured"),
      {"points.count", &points.count, "points", 50, 5000, "points tracked at once"},
      {"points.spacing", &points.spacing, "px", 1, 100, "least distance between two points"},
      {"points.cell", &points.cell, "px", 4, 1000, "side of a cell of the grid over which points are spread"},
      {"points.corner_share", &points.corner_share, "", 0, 1,
       "most of the points that corner-like ones may take first"},
      {"points.tensor_window", &points.tensor_window, "px", 3, 63, "side of the structure tensor's window", 2},
      {"points.corner_ratio", &points.corner_ratio, "", 0, 1,
       "corner-like: smaller over larger eigenvalue above this ..."},
      {"points.corner_strength", &points.corner_strength, "grey^2/px^2", 0, 10000,
       "... and smaller eigenvalue above this"},
      {"points.noise", &points.noise, "grey^2/px^2", 0, 10000,
       "usual noise of the structure tensor; where an image has more, that is measured"},
      {"points.sigma_edge", &points.sigma_edge, "px", 0.01, 10, "standard deviation of a measurement across an edge"},
      {"points.sigma_corner", &points.sigma_corner, "px", 0.01, 10, "the same of a corner-like point"},
      {"points.border", &points.border, "px", 0, 200, "points keep this distance from the image's border"},

      {"points.weigh_edges", &points.weigh_edges, "", 0, 0,
       "false counts a point as well known along its edge as across; to measure the gain"},

      heading("pose", "Pose of each frame: robust Gauss-Newton on the edge measurements"),
      {"pose.iterations", &pose.iterations, "", 1, 100, "most Gauss-Newton steps"},
      {"pose.huber", &pose.huber, "sigma", 0.1, 100, "from here on the error of a measurement counts linearly"},
      {"pose.outlier", &pose.outlier, "sigma", 0.1, 100, "from here on a measurement is an outlier"},
      {"pose.fewest", &pose.fewest, "points", 4, 1000, "with fewer measurements or inliers there is no pose"},
      {"pose.unmapped_depth_sigma", &pose.unmapped_depth_sigma, "", 0, 10,
       "of the depth guessed for a track that has none, share of it; 0: such tracks do not help"},
      {"pose.unmapped_weakening", &pose.unmapped_weakening, "", 1, 100,
       "the standard deviations of what such tracks measure count so many times"},

      heading("flow", "Flow: bidirectional pyramidal Lucas-Kanade, and the correspondence filters"),
      {"flow.window", &flow.window, "px", 5, 15, "side of the patch", 2},
      {"flow.levels", &flow.levels, "", 1, 8, "levels of the image pyramid"},
      {"flow.iterations", &flow.iterations, "", 1, 100, "most steps a level"},
      {"flow.damping", &flow.damping, "grey^2/px^2", 0, 1000, "pull towards the predicted position"},
      {"flow.forward_backward", &flow.forward_backward, "px", 0.01, 100,
       "largest error there and back, across the edge"},
      {"flow.least_correlation", &flow.least_correlation, "", -1, 1, "of a patch with its image in the next frame"},
      {"flow.edge_distance", &flow.edge_distance, "px", 0.1, 20, "a point farther from every edge is dropped"},
      {"flow.redundancy", &flow.redundancy, "px", 0, 20, "of two points nearer to each other the younger is dropped"},

      heading("refinement", "Refinement of each point against its keyframe's patch"),
      {"refinement.enabled", &refinement.enabled, "", 0, 0, "off only to measure what it gains"},
      {"refinement.window", &refinement.window, "px", 5, 15, "side of the patch", 2},
      {"refinement.iterations", &refinement.iterations, "", 1, 100, "most steps"},
      {"refinement.damping", &refinement.damping, "grey^2/px^2", 0, 1000, "pull towards the flow's result"},
      {"refinement.least_correlation", &refinement.least_correlation, "", -1, 1, "below it the point is dropped"},
      {"refinement.largest_move", &refinement.largest_move, "px", 0.1, 20,
       "a larger one across the edge is not believed"},

      heading("edge_lock", "Points of straight edges are held at their map point along the edge"),
      {"edge_lock.enabled", &edge_lock.enabled, "", 0, 0, "off only to measure what it gains"},
      {"edge_lock.straightness", &edge_lock.straightness, "", 0, 1,
       "held where the standard deviation across is below this share of that along"},
      {"edge_lock.longest_move", &edge_lock.longest_move, "px", 0, 100, "a longer way is not taken"},

      heading("map_reuse", "Map points that come into view again are found and followed on"),
      {"map_reuse.enabled", &reuse.enabled, "", 0, 0, "off only to measure what it gains"},
      {"map_reuse.interval", &reuse.interval, "frames", 1, 1000,
       "from one search to the next; keyframes search besides"},
      {"map_reuse.radius", &reuse.search.radius, "px", 0.5, 50, "searched around the projection"},
      {"map_reuse.least_correlation", &reuse.search.least_correlation, "", -1, 1, "with the keyframe's patch"},
      {"map_reuse.outlier_px", &reuse.outlier_px, "px", 0.1, 100, "farther across its edge a point is not believed"},
      {"map_reuse.latest_keyframes", &view.latest_keyframes, "keyframes", 1, 1000, "whose points are looked for"},
      {"map_reuse.near_keyframes", &view.near_keyframes, "keyframes", 0, 1000,
       "older ones at the same place, likewise"},
      {"map_reuse.largest_turn_deg", &view.largest_turn_deg, "deg", 0, 180, "between these and the latest keyframe"},
      {"map_reuse.largest_distance", &view.largest_distance, "", 0, 100, "to these, as a share of the scene's depth"},

      heading("tracking", "State of tracking"),
      {"tracking.fewest_tracks", &tracking.fewest_tracks, "points", 8, 1000, "fewer do not start a map"},
      {"tracking.restart_share", &tracking.restart_share, "", 0, 1,
       "of the first frame's points: fewer left, a new start"},
      {"tracking.outlier_frames", &tracking.outlier_frames, "frames", 1, 1000,
       "a point that misses the pose so often in a row is dropped"},
      {"tracking.least_inlier_share", &tracking.least_inlier_share, "", 0, 1,
       "of the map points followed: fewer agree, and the pose is not believed"},

      heading("keyframes", "Choice of the keyframes (P8 to P12)"),
      {"keyframes.rotation_deg", &keyframes.rotation_deg, "deg", 1, 180, "rotation since the last keyframe"},
      {"keyframes.track_share", &keyframes.track_share, "", 0, 1, "correspondences left, of their running average"},
      {"keyframes.fewest_mapped", &keyframes.fewest_mapped, "points", 4, 10000, "map points followed ..."},
      {"keyframes.mapped_share", &keyframes.mapped_share, "", 0, 1, "... or this share of those at the last keyframe"},
      {"keyframes.displacement_share", &keyframes.displacement_share, "", 0, 1,
       "mean displacement since the last keyframe, of the image's width"},
      {"keyframes.interval_s", &keyframes.interval_s, "s", 0.05, 60, "at the latest after this time"},
      {"keyframes.least_frames_apart", &keyframes.least_frames_apart, "frames", 1, 1000, "never nearer"},

      heading("initialisation", "Start of the map (P13 to P15)"),
      {"initialisation.frames_between", &initialisation.frames_between, "frames", 0, 50,
       "adjusted with the first and the current one"},
      {"initialisation.attempt_interval", &initialisation.attempt_interval, "frames", 1, 100,
       "from attempt to attempt"},
      {"initialisation.least_displacement_px", &initialisation.least_displacement_px, "px", 0, 1000,
       "median motion of the points beyond a rotation"},
      {"initialisation.least_parallax_deg", &initialisation.least_parallax_deg, "deg", 0.01, 90,
       "median angle between the first and the current camera, seen from the points"},
      {"initialisation.prior_sigma", &initialisation.prior_sigma, "", 0.01, 100,
       "of the inverse depth around its mean"},
      {"initialisation.largest_depth_sigma", &initialisation.largest_depth_sigma, "", 0.01, 10,
       "a point counts where its depth is better known than this share"},
      {"initialisation.fewest_points", &initialisation.fewest_points, "points", 8, 10000, "that must count ..."},
      {"initialisation.point_share", &initialisation.point_share, "", 0, 1, "... or this share of those followed"},
      {"initialisation.five_point_corners", &initialisation.five_point_corners, "points", 8, 10000,
       "corner-like points from which on the five-point start is tried too"},
      {"initialisation.least_quality", &initialisation.least_quality, "", 0, 1,
       "share of the edge pieces that must hold"},
      {"initialisation.neighbour_px", &quality.neighbour_px, "px", 1, 200, "farthest neighbours in an edge piece"},
      {"initialisation.straight_px", &quality.straight_px, "px", 0.1, 20, "a piece is straight within this"},
      {"initialisation.same_depth_ratio", &quality.same_depth_ratio, "", 0, 1,
       "neighbours' depths agree within this share"},
      {"initialisation.straight_depth_ratio", &quality.straight_depth_ratio, "", 0, 1,
       "the middle of a straight piece lies on its chord within this share of the depth"},

      heading("new_points", "New map points (P7, P17)"),
      {"new_points.largest_depth_sigma", &new_points.largest_depth_sigma, "", 0.01, 10,
       "standard deviation over depth"},
      {"new_points.least_parallax_deg", &new_points.least_parallax_deg, "deg", 0.01, 90, "angle between two rays"},
      {"new_points.largest_error", &new_points.largest_error, "sigma", 0.1, 100, "reprojection error in any view"},
      {"new_points.three_view_error", &new_points.three_view_error, "sigma", 0.1, 1000, "of the three-view check"},
      {"new_points.fewest_views", &new_points.fewest_views, "keyframes", 2, 10, "that must see a new point"},

      heading("adjustment", "Local bundle adjustment (P18, P19)"),
      {"adjustment.free_keyframes", &adjustment.free_keyframes, "keyframes", 2, 100, "adjusted around the new one"},
      {"adjustment.fixed_keyframes", &adjustment.fixed_keyframes, "keyframes", 1, 200, "held, to hold the others"},
      {"adjustment.covisible_points", &adjustment.covisible_points, "points", 1, 10000,
       "common points of two covisible keyframes ..."},
      {"adjustment.covisible_share", &adjustment.covisible_share, "", 0, 1, "... or this share of the most there are"},
      {"adjustment.outlier", &adjustment.outlier, "sigma", 0.1, 100, "observations with a larger error are taken out"},
      {"adjustment.largest_depth_sigma", &adjustment.largest_depth_sigma, "", 0.01, 10,
       "points whose depth is known worse than this share are taken out"},

      heading("culling", "Keyframes that add nothing are taken out; the map stays within its bounds"),
      {"culling.enabled", &culling.enabled, "", 0, 0, "off only to measure what it costs"},
      {"culling.recent_keyframes", &culling.recent_keyframes, "keyframes", 3, 1000, "the latest so many stay"},
      {"culling.other_views", &culling.other_views, "keyframes", 1, 100,
       "a point that so many others see does not need a keyframe ..."},
      {"culling.redundant_share", &culling.redundant_share, "", 0.1, 1,
       "... and a keyframe that this share of its points does not need is taken out"},
      {"culling.most_keyframes", &culling.most_keyframes, "keyframes", 20, 100000, "most that the map keeps"},
      {"culling.most_megabytes", &culling.most_megabytes, "MB", 10, 1000000, "most memory that the map takes"},

      heading("pipeline", "Schedule"),
      {"pipeline.view_delay_frames", &settings.view_delay_frames, "frames", 1, 100,
       "the map that follows from a keyframe is used so many frames later"},

      heading("threads", "Threads of a live run; what is not allowed is told and left out"),
      {"threads.capture_priority", &threads.capture_priority, "", 0, 99,
       "real-time priority (SCHED_FIFO); 0: the usual scheduling"},
      {"threads.tracking_priority", &threads.tracking_priority, "", 0, 99, "likewise"},
      {"threads.publishing_priority", &threads.publishing_priority, "", 0, 99, "likewise"},
      {"threads.mapping_nice", &threads.mapping_nice, "", 0, 19, "nice level"},
      {"threads.places_nice", &threads.places_nice, "", 0, 19, "nice level"},
      {"threads.tracking_processor", &threads.tracking_processor, "", -1, 1023,
       "the thread keeps to this processor; -1: any"},
      {"threads.mapping_processor", &threads.mapping_processor, "", -1, 1023, "likewise"},
      {"threads.places_processor", &threads.places_processor, "", -1, 1023, "likewise"},
      {"threads.lock_memory", &threads.lock_memory, "", 0, 0, "keeps the program's memory from being swapped out"},

      heading("recovery", "Track-loss recovery (P21) and relocalisation (P22)"),
      {"recovery.enabled", &settings.mapping.recovery_enabled, "", 0, 0, "off only to measure what it gains"},
      {"recovery.fewest_inliers", &settings.mapping.recovery.fewest_inliers, "points", 10, 10000,
       "that must fit three views ..."},
      {"recovery.inlier_share", &settings.mapping.recovery.inlier_share, "", 0, 1, "... or this share of the tracks"},
      {"recovery.relocalisation", &settings.relocalisation_enabled, "", 0, 0, "off only to measure what it gains"},

      heading("loops", "Loop closing (P23 to P27) and adjustment of the whole map (P20)"),
      {"loops.enabled", &settings.loops.enabled, "", 0, 0, "off only to measure what it gains"},
      {"loops.global_interval_keyframes", &settings.places.global_interval_keyframes, "keyframes", 2, 10000,
       "from one adjustment of the whole map to the next ..."},
      {"loops.global_interval_s", &settings.places.global_interval_s, "s", 1, 10000, "... at the latest"},

      heading("bundle", "Solver of the local bundle adjustment"),
      {"bundle.iterations", &bundle.iterations, "", 1, 1000, "most steps"},
      {"bundle.huber", &bundle.huber, "sigma", 0.1, 100, "from here on the error of a measurement counts linearly"},
  };
}

std::string numberText(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value).ptr;
  return std::string(digits, end);
}

std::string valueText(const ConfigurationField& field) {
  if (const auto* number = std::get_if<double*>(&field)) return numberText(**number);
  if (const auto* count = std::get_if<int*>(&field)) return std::to_string(**count);
  if (const auto* flag = std::get_if<bool*>(&field)) return **flag ? "true" : "false";
  return "";
}

std::string expectedValue(const ConfigurationKey& key) {
  if (std::holds_alternative<bool*>(key.field)) return "true or false";
  return numberText(key.least) + " to " + numberText(key.largest) + (key.unit.empty() ? "" : " " + key.unit) +
         (key.step > 1 ? " in steps of " + std::to_string(key.step) : "");
}

bool parseNumber(const std::string& text, double& value) {
  const char* begin = text.data() + (text.size() > 1 && text[0] == '+' && text[1] != '-' ? 1 : 0);
  const char* end = text.data() + text.size();
  double number = 0;
  const auto [stop, error] = std::from_chars(begin, end, number);
  if (error != std::errc() || stop != end || !std::isfinite(number)) return false;
  value = number;
  return true;
}

std::string setValue(const ConfigurationKey& key, const std::string& text) {
  if (const auto* flag = std::get_if<bool*>(&key.field)) {
    if (text != "true" && text != "false") return "'" + text + "' is neither true nor false";
    **flag = text == "true";
    return "";
  }
  double value = 0;
  if (!parseNumber(text, value)) return "'" + text + "' is not a finite number";
  const auto* count = std::get_if<int*>(&key.field);
  if (count && value != std::floor(value)) return "'" + text + "' is not a whole number";
  if (value < key.least || value > key.largest) return text + " is out of range";
  if (count && std::fmod(value - key.least, key.step) != 0) return text + " is between the steps";
  if (count) {
    **count = static_cast<int>(value);
  } else if (const auto* number = std::get_if<double*>(&key.field)) {
    **number = value;
  }
  return "";
}

}  // namespace edgeslam
