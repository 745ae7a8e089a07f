// How long a camera's sensor takes to read its rows, where its driver tells. It tells this of global shutters, too,
// whose rows are exposed all at once: whether the shutter is a rolling one, no driver says.
#pragma once

#include <opencv2/core/types.hpp>
#include <optional>

#include "drivers/v4l2/capture_device.h"
#include "drivers/v4l2/stream_setup.h"

namespace edgeslam {

// From the first row's reading to the last one's [s]. `line_length`: from the start of a row to that of the next, in
// pixels that are read at `pixel_rate` [1/s]. 0 where the numbers cannot be, or come to more than a calibration may
// say.
double readoutOf(double rows, double line_length, double pixel_rate);

struct SensorRows {
  int width = 0, height = 0;  // that the sensor gives, binned and cropped [px]
  double readout_s = 0;       // over all of the height
};

// In the present mode. `image`: the size of the images, which is that of the sensor where the video device itself has
// the sensor's controls. Nothing where the driver does not tell.
std::optional<SensorRows> sensorRows(const CaptureDevice& device, cv::Size image);

// Of the images' rows [s]; 0 where it is not known: the driver does not tell, or the images have another size than the
// sensor gives, so that they may be a part of them or all, or the rows would take longer than a frame.
double readoutOfImages(const CaptureDevice& device, const StreamSetup& setup);

}  // namespace edgeslam
