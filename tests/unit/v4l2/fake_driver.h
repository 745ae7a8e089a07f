// A V4L2 driver that lives in memory and fails where a test says so.
#pragma once

#include <linux/media.h>
#include <linux/v4l2-subdev.h>
#include <linux/videodev2.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "drivers/v4l2/system_calls.h"

namespace edgeslam {

class FakeDriver : public SystemCalls {
 public:
  struct Size {
    std::uint32_t width, height;
    std::vector<std::uint32_t> rates;  // [1/s]
  };
  struct Format {
    std::uint32_t code;
    std::vector<Size> sizes;
  };
  struct Control {
    std::string name;
    std::uint32_t type;
    std::int32_t least, largest, step, value;
    std::map<int, std::string> menu;
    std::uint32_t flags = 0;
  };

  // What the test arranges.
  bool plugged = true;
  bool multi_planar = false;
  std::uint32_t capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  std::vector<Format> formats{{v4l2_fourcc('Y', 'U', 'Y', 'V'), {{64, 48, {30, 15}}, {32, 24, {60, 30}}}},
                              {v4l2_fourcc('G', 'R', 'E', 'Y'), {{64, 48, {30, 15}}}}};
  std::map<std::uint32_t, Control> controls;
  std::map<unsigned long, std::deque<int>> failures;  // errno by request, for the next calls; 0: that one works
  std::deque<int> wait_failures;
  int open_failure = 0, map_failure = 0;
  std::uint32_t buffer_flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_TSTAMP_SRC_SOE;
  std::uint32_t extra_stride = 0;
  std::uint32_t data_offset = 0;
  bool has_crop = false;
  v4l2_rect crop{0, 0, 128, 96};
  // By VIDIOC_G_EXT_CTRLS: of the video device, and of the sensor, which is a sub-device of its own.
  std::map<std::uint32_t, std::int64_t> own_numbers, sensor_numbers;
  std::uint32_t sensor_width = 64, sensor_height = 48;
  // The media device of video7 (81:7); empty: there is none. The sensor's file is 81:9.
  std::uint64_t device_number = makedev(81, 7);
  std::vector<media_v2_entity> entities;
  std::vector<media_v2_interface> interfaces;
  std::vector<media_v2_pad> pads;
  std::vector<media_v2_link> links;

  // What it saw.
  std::set<void*> mapped;
  int open_files = 0;
  bool streaming = false;
  std::int64_t time_ns = 100'000'000'000;
  std::vector<std::pair<std::uint32_t, std::int32_t>> set_controls;

  // A frame is filled whose pixels' bytes all are `value`; false where the program has left no buffer.
  bool fill(std::uint8_t value, std::uint32_t sequence, std::int64_t stamp_ns, std::uint32_t flags = 0,
            int missing_bytes = 0) {
    return fill(std::vector<std::uint8_t>(imageBytes(), value).data(), sequence, stamp_ns, flags, missing_bytes);
  }
  // `image`: of the size and format that are set.
  bool fill(const std::uint8_t* image, std::uint32_t sequence, std::int64_t stamp_ns, std::uint32_t flags = 0,
            int missing_bytes = 0) {
    if (!streaming || queued_.empty()) return false;
    const std::uint32_t index = queued_.front();
    queued_.pop_front();
    std::memcpy(memory_[index].data() + data_offset, image, memory_[index].size() - data_offset);
    v4l2_buffer buffer{};
    buffer.index = index;
    buffer.sequence = sequence;
    buffer.flags = buffer_flags | flags;
    buffer.timestamp.tv_sec = stamp_ns / 1'000'000'000;
    buffer.timestamp.tv_usec = stamp_ns % 1'000'000'000 / 1000;
    buffer.bytesused = static_cast<std::uint32_t>(static_cast<int>(memory_[index].size()) - missing_bytes);
    filled_.push_back(buffer);
    return true;
  }

  int openFile(const char* path) override {
    const std::string name = path;
    const bool is_media = name.rfind("/dev/media", 0) == 0, is_sensor = name == "/dev/char/81:9";
    if (is_media && (entities.empty() || name != "/dev/media1")) return -ENOENT;
    if (open_failure != 0) return -open_failure;
    if (!plugged) return -ENOENT;
    ++open_files;
    return is_media ? media_file : is_sensor ? sensor_file : 7;
  }
  void closeFile(int) override { --open_files; }
  std::uint64_t deviceNumber(int) override { return device_number; }
  int control(int file, unsigned long request, void* argument) override {
    std::deque<int>& next = failures[request];
    if (!next.empty()) {
      const int error = next.front();
      next.pop_front();
      if (error != 0) return -error;
    }
    if (!plugged && request != VIDIOC_REQBUFS) return -ENODEV;
    if (request == VIDIOC_G_EXT_CTRLS) {
      return number(file == sensor_file ? sensor_numbers : own_numbers, *static_cast<v4l2_ext_controls*>(argument));
    }
    if (file == media_file) return tellTopology(*static_cast<media_v2_topology*>(argument));
    if (file == sensor_file) return tellSensor(*static_cast<v4l2_subdev_format*>(argument));
    return answer(request, argument);
  }
  int map(int, std::size_t length, std::int64_t offset, void** memory) override {
    if (map_failure != 0) return -map_failure;
    std::vector<std::uint8_t>& buffer = memory_.at(static_cast<std::size_t>(offset));
    if (length != buffer.size()) return -EINVAL;
    *memory = buffer.data();
    mapped.insert(*memory);
    return 0;
  }
  void unmap(void* memory, std::size_t) override { mapped.erase(memory); }
  int wait(pollfd* descriptor, int timeout_ms) override {
    if (!wait_failures.empty()) {
      const int error = wait_failures.front();
      wait_failures.pop_front();
      if (error < 0) return error;
      descriptor->revents = static_cast<short>(error);
      return 1;
    }
    if (!plugged) {
      descriptor->revents = POLLERR | POLLHUP;
      return 1;
    }
    if (filled_.empty()) {
      time_ns += std::int64_t{timeout_ms} * 1'000'000;
      return 0;
    }
    descriptor->revents = POLLIN;
    return 1;
  }
  std::int64_t now_ns() override { return time_ns; }

 private:
  // Descriptors that no real file has: a program's own may be handed to control().
  static constexpr int media_file = 1'000'008, sensor_file = 1'000'009;

  static int number(const std::map<std::uint32_t, std::int64_t>& numbers, v4l2_ext_controls& asked) {
    const auto found = numbers.find(asked.controls->id);
    if (found == numbers.end()) return -EINVAL;
    if (found->first == V4L2_CID_PIXEL_RATE) {
      asked.controls->value64 = found->second;
    } else {
      asked.controls->value = static_cast<std::int32_t>(found->second);
    }
    return 0;
  }
  template <typename Part>
  static void tellParts(const std::vector<Part>& parts, std::uint32_t& count, std::uint64_t told) {
    count = static_cast<std::uint32_t>(parts.size());
    if (told != 0) std::copy(parts.begin(), parts.end(), reinterpret_cast<Part*>(told));
  }
  int tellTopology(media_v2_topology& told) const {
    media_v2_topology t = told;
    std::uint32_t count = 0;
    tellParts(entities, count, t.ptr_entities), told.num_entities = count;
    tellParts(interfaces, count, t.ptr_interfaces), told.num_interfaces = count;
    tellParts(pads, count, t.ptr_pads), told.num_pads = count;
    tellParts(links, count, t.ptr_links), told.num_links = count;
    return 0;
  }
  int tellSensor(v4l2_subdev_format& format) const {
    format.format.width = sensor_width;
    format.format.height = sensor_height;
    return 0;
  }

  int answer(unsigned long request, void* argument) {
    switch (request) {
      case VIDIOC_QUERYCAP: {
        auto& capability = *static_cast<v4l2_capability*>(argument);
        std::memcpy(capability.card, "Fake", 5);
        std::memcpy(capability.driver, "fake", 5);
        capability.capabilities = V4L2_CAP_DEVICE_CAPS;
        capability.device_caps = capabilities;
        return 0;
      }
      case VIDIOC_ENUM_FMT: {
        auto& entry = *static_cast<v4l2_fmtdesc*>(argument);
        if (entry.index >= formats.size() || entry.type != type()) return -EINVAL;
        entry.pixelformat = formats[entry.index].code;
        return 0;
      }
      case VIDIOC_ENUM_FRAMESIZES: {
        auto& entry = *static_cast<v4l2_frmsizeenum*>(argument);
        const Format* const format = find(entry.pixel_format);
        if (format == nullptr || entry.index >= format->sizes.size()) return -EINVAL;
        entry.type = V4L2_FRMSIZE_TYPE_DISCRETE;
        entry.discrete = {format->sizes[entry.index].width, format->sizes[entry.index].height};
        return 0;
      }
      case VIDIOC_ENUM_FRAMEINTERVALS: {
        auto& entry = *static_cast<v4l2_frmivalenum*>(argument);
        const Size* const size = find(entry.pixel_format, entry.width, entry.height);
        if (size == nullptr || entry.index >= size->rates.size()) return -EINVAL;
        entry.type = V4L2_FRMIVAL_TYPE_DISCRETE;
        entry.discrete = {1, size->rates[entry.index]};
        return 0;
      }
      case VIDIOC_S_FMT:
        return setFormat(*static_cast<v4l2_format*>(argument));
      case VIDIOC_G_FMT:
        fillFormat(*static_cast<v4l2_format*>(argument));
        return 0;
      case VIDIOC_G_PARM:
      case VIDIOC_S_PARM:
        return setRate(request == VIDIOC_S_PARM, *static_cast<v4l2_streamparm*>(argument));
      case VIDIOC_G_SELECTION:
      case VIDIOC_S_SELECTION:
        return select(request == VIDIOC_S_SELECTION, *static_cast<v4l2_selection*>(argument));
      case VIDIOC_QUERYCTRL:
        return queryControl(*static_cast<v4l2_queryctrl*>(argument));
      case VIDIOC_QUERYMENU: {
        auto& entry = *static_cast<v4l2_querymenu*>(argument);
        const auto control = controls.find(entry.id);
        if (control == controls.end() || control->second.menu.count(static_cast<int>(entry.index)) == 0) return -EINVAL;
        const std::string& name = control->second.menu.at(static_cast<int>(entry.index));
        std::memcpy(entry.name, name.c_str(), std::min<std::size_t>(name.size() + 1, sizeof entry.name));
        return 0;
      }
      case VIDIOC_G_CTRL:
      case VIDIOC_S_CTRL: {
        auto& call = *static_cast<v4l2_control*>(argument);
        const auto control = controls.find(call.id);
        if (control == controls.end()) return -EINVAL;
        if (request == VIDIOC_S_CTRL) {
          control->second.value = call.value;
          set_controls.emplace_back(call.id, call.value);
        }
        call.value = control->second.value;
        return 0;
      }
      case VIDIOC_REQBUFS: {
        auto& buffers = *static_cast<v4l2_requestbuffers*>(argument);
        queued_.clear();
        filled_.clear();
        memory_.assign(buffers.count, std::vector<std::uint8_t>(imageBytes() + data_offset));
        return 0;
      }
      case VIDIOC_QUERYBUF: {
        auto& buffer = *static_cast<v4l2_buffer*>(argument);
        if (buffer.index >= memory_.size()) return -EINVAL;
        const auto length = static_cast<std::uint32_t>(memory_[buffer.index].size());
        if (multi_planar) {
          buffer.m.planes[0].length = length;
          buffer.m.planes[0].m.mem_offset = buffer.index;
        } else {
          buffer.length = length;
          buffer.m.offset = buffer.index;
        }
        return 0;
      }
      case VIDIOC_QBUF:
        queued_.push_back(static_cast<v4l2_buffer*>(argument)->index);
        return 0;
      case VIDIOC_DQBUF:
        return dequeue(*static_cast<v4l2_buffer*>(argument));
      case VIDIOC_STREAMON:
      case VIDIOC_STREAMOFF:
        streaming = request == VIDIOC_STREAMON;
        return 0;
      default:
        return -ENOTTY;
    }
  }

  std::uint32_t type() const { return multi_planar ? V4L2_BUF_TYPE_VIDEO_CAPTURE_MPLANE : V4L2_BUF_TYPE_VIDEO_CAPTURE; }
  const Format* find(std::uint32_t code) const {
    const auto found = std::find_if(formats.begin(), formats.end(), [&](const auto& f) { return f.code == code; });
    return found == formats.end() ? nullptr : &*found;
  }
  const Size* find(std::uint32_t code, std::uint32_t width, std::uint32_t height) const {
    const Format* const format = find(code);
    if (format == nullptr) return nullptr;
    const auto found = std::find_if(format->sizes.begin(), format->sizes.end(),
                                    [&](const Size& size) { return size.width == width && size.height == height; });
    return found == format->sizes.end() ? nullptr : &*found;
  }
  std::uint32_t stride() const {
    const bool two_bytes = code_ != v4l2_fourcc('G', 'R', 'E', 'Y');
    return size_.width * (two_bytes ? 2 : 1) + extra_stride;
  }
  std::size_t imageBytes() const { return std::size_t{stride()} * size_.height; }

  int setFormat(v4l2_format& format) {
    if (format.type != type()) return -EINVAL;
    const std::uint32_t code = multi_planar ? format.fmt.pix_mp.pixelformat : format.fmt.pix.pixelformat;
    const std::uint32_t width = multi_planar ? format.fmt.pix_mp.width : format.fmt.pix.width;
    const std::uint32_t height = multi_planar ? format.fmt.pix_mp.height : format.fmt.pix.height;
    const Format* const found = find(code) != nullptr ? find(code) : &formats.front();
    const Size* const size = find(found->code, width, height);
    code_ = found->code;
    size_ = size != nullptr ? *size : found->sizes.front();  // as drivers do: something near
    rate_ = size_.rates.front();
    fillFormat(format);
    return 0;
  }
  void fillFormat(v4l2_format& format) const {
    if (multi_planar) {
      format.fmt.pix_mp.pixelformat = code_;
      format.fmt.pix_mp.width = size_.width;
      format.fmt.pix_mp.height = size_.height;
      format.fmt.pix_mp.num_planes = 1;
      format.fmt.pix_mp.plane_fmt[0].bytesperline = stride();
    } else {
      format.fmt.pix.pixelformat = code_;
      format.fmt.pix.width = size_.width;
      format.fmt.pix.height = size_.height;
      format.fmt.pix.bytesperline = stride();
    }
  }
  int setRate(bool set, v4l2_streamparm& parameters) {
    if (set) {
      const v4l2_fract& interval = parameters.parm.capture.timeperframe;
      const std::uint32_t wanted = interval.denominator / std::max(interval.numerator, 1U);
      const auto& rates = size_.rates;
      const auto found = std::find(rates.begin(), rates.end(), wanted);
      rate_ = found != rates.end() ? *found : rates.back();
    }
    parameters.parm.capture.capability = V4L2_CAP_TIMEPERFRAME;
    parameters.parm.capture.timeperframe = {1, rate_};
    return 0;
  }
  int select(bool set, v4l2_selection& selection) {
    if (!has_crop) return -ENOTTY;
    if (selection.target == V4L2_SEL_TGT_CROP_BOUNDS) {
      selection.r = {0, 0, 128, 96};
      return 0;
    }
    if (set) {
      crop = selection.r;
      crop.width = std::min(crop.width, 128U);
      crop.height = std::min(crop.height, 96U);
    }
    selection.r = crop;
    return 0;
  }
  int queryControl(v4l2_queryctrl& query) const {
    const std::uint32_t last = query.id & ~V4L2_CTRL_FLAG_NEXT_CTRL;
    const auto control = controls.upper_bound(last);
    if (control == controls.end()) return -EINVAL;
    query = {};
    query.id = control->first;
    query.type = control->second.type;
    std::memcpy(query.name, control->second.name.c_str(), control->second.name.size() + 1);
    query.minimum = control->second.least;
    query.maximum = control->second.largest;
    query.step = control->second.step;
    query.flags = control->second.flags;
    return 0;
  }
  int dequeue(v4l2_buffer& buffer) {
    if (filled_.empty()) return -EAGAIN;
    v4l2_plane* const planes = buffer.m.planes;
    buffer = filled_.front();
    filled_.pop_front();
    if (multi_planar) {
      planes[0].bytesused = buffer.bytesused;
      planes[0].data_offset = data_offset;
      buffer.m.planes = planes;
    }
    return 0;
  }

  std::uint32_t code_ = v4l2_fourcc('Y', 'U', 'Y', 'V');
  Size size_{64, 48, {30, 15}};
  std::uint32_t rate_ = 30;
  std::vector<std::vector<std::uint8_t>> memory_;
  std::deque<std::uint32_t> queued_;
  std::deque<v4l2_buffer> filled_;
};

}  // namespace edgeslam
