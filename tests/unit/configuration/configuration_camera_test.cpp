#include <gtest/gtest.h>

#include "configuration/configuration.h"
#include "configuration/configuration_text.h"
#include "geometry/camera_mask.h"
#include "unit/files/temporary_folder.h"

namespace edgeslam {
namespace {

const std::string calibration_text =
    "width: 640, height: 480, fx: 500, fy: 501, cx: 320, cy: 240, k1: 0.1, k2: -0.2, p1: 0.01, p2: 0.02, k3: 0.3";

Configuration configurationWithCameras(const std::string& text) {
  const TemporaryFolder folder;
  folder.write("cameras/known.yaml", "width: 640\nheight: 480\nfx: 500\nfy: 501\ncx: 320\ncy: 240\nk1: 0.1\n");
  folder.write("cameras/rolling.yaml", "width: 64\nheight: 48\nfx: 50\nfy: 50\ncx: 32\ncy: 24\nreadout: 0.03\n");
  folder.write("cameras/bad.yaml", "width: 640\nheight: 480\nfx: -500\nfy: 501\ncx: 320\ncy: 240\n");
  return readConfiguration(folder.write("file.yaml", text));
}

void expectCameraRefused(const std::string& text, const std::string& part) {
  try {
    configurationWithCameras(text);
    ADD_FAILURE() << "not refused: " << text;
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(ConfigurationCamera, ReadsAnInlineCalibration) {
  const Configuration read = configurationWithCameras("camera: {" + calibration_text + "}\n");
  ASSERT_TRUE(read.camera);
  EXPECT_EQ(read.camera->model, CameraModel::pinhole_radial_tangential);
  EXPECT_EQ(read.camera->width, 640);
  EXPECT_EQ(read.camera->height, 480);
  EXPECT_EQ(read.camera->fx, 500);
  EXPECT_EQ(read.camera->fy, 501);
  EXPECT_EQ(read.camera->cx, 320);
  EXPECT_EQ(read.camera->cy, 240);
  EXPECT_EQ(read.camera->distortion, (std::array<double, 5>{0.1, -0.2, 0.01, 0.02, 0.3}));
}

TEST(ConfigurationCamera, TellsADistortionThatCannotBeRight) {
  EXPECT_EQ(configurationWithCameras("camera: {" + calibration_text + "}\n").camera_doubt, "");
  const Configuration read = configurationWithCameras(
      "camera: {width: 640, height: 480, fx: 320, fy: 320, cx: 320, cy: 240, k1: 0.02, k2: 0.04, k3: -0.08}\n");
  EXPECT_NE(read.camera_doubt.find("the farthest corner is at 400"), std::string::npos) << read.camera_doubt;
  EXPECT_EQ(read.camera->distortion[4], 0) << "another takes its place";
}

TEST(ConfigurationCamera, ReadsAFisheye) {
  const Configuration read = configurationWithCameras(
      "camera: {model: kannala_brandt, width: 640, height: 480, fx: 300, fy: 300, cx: 320, cy: 240, k1: 1, k2: 2, k3: "
      "3, k4: 4}\n");
  ASSERT_TRUE(read.camera);
  EXPECT_EQ(read.camera->model, CameraModel::kannala_brandt);
  EXPECT_EQ(read.camera->distortion, (std::array<double, 5>{1, 2, 3, 4, 0}));
}

TEST(ConfigurationCamera, ReadsACalibrationFileRelativeToItself) {
  const Configuration read = configurationWithCameras("camera:\n  calibration: cameras/known.yaml\n");
  ASSERT_TRUE(read.camera);
  EXPECT_EQ(read.camera->fy, 501);
}

TEST(ConfigurationCamera, ReadsTheReadoutOfAnInlineCalibration) {
  const Configuration read = configurationWithCameras("camera: {" + calibration_text + ", readout: -0.016}\n");
  ASSERT_TRUE(read.camera);
  EXPECT_EQ(read.camera->readout_s, -0.016);
  EXPECT_EQ(configurationWithCameras("camera: {" + calibration_text + "}\n").camera->readout_s, 0);
  EXPECT_EQ(configurationWithCameras(formatConfiguration(read)).camera, read.camera);
}

TEST(ConfigurationCamera, AReadoutOverrulesThatOfACalibrationFile) {
  EXPECT_EQ(configurationWithCameras("camera: {calibration: cameras/rolling.yaml}\n").camera->readout_s, 0.03);
  const Configuration read = configurationWithCameras("camera: {calibration: cameras/rolling.yaml, readout: 0.02}\n");
  EXPECT_EQ(read.camera->width, 64);
  EXPECT_EQ(read.camera->readout_s, 0.02);
  EXPECT_EQ(configurationWithCameras("camera: {calibration: cameras/rolling.yaml, readout: 0}\n").camera->readout_s, 0);
  EXPECT_EQ(configurationWithCameras("camera: {calibration: cameras/known.yaml, readout: 0.2}\n").camera->readout_s,
            0.2);
}

TEST(ConfigurationCamera, AReadoutByItselfIsOfWhateverCalibrationIsTaken) {
  const Configuration read = configurationWithCameras(
      "camera: {readout: 0.02, body_T_camera: {translation: [1, 2, 3], quaternion: [1, 0, 0, 0]}}\n");
  EXPECT_FALSE(read.camera);
  Camera beside;
  beside.readout_s = 0.01;
  EXPECT_EQ(asConfigured(beside, read).readout_s, 0.02);
  EXPECT_EQ(asConfigured(beside, Configuration()).readout_s, 0.01);
  const Configuration again = configurationWithCameras(formatConfiguration(read));
  EXPECT_FALSE(again.camera);
  EXPECT_EQ(again.readout_s, 0.02);
}

// Also as 0, which a calibration without it has as well.
TEST(ConfigurationCamera, WhetherTheReadoutIsGivenIsKnown) {
  const auto has = [](const std::string& camera) {
    return configurationWithCameras("camera: {" + camera + "}\n").has_readout;
  };
  EXPECT_TRUE(has("readout: 0"));
  EXPECT_TRUE(has("calibration: cameras/known.yaml, readout: 0"));
  EXPECT_TRUE(has(calibration_text + ", readout: 0"));
  EXPECT_FALSE(has("calibration: cameras/rolling.yaml"));
  EXPECT_FALSE(has(calibration_text));
  EXPECT_FALSE(configurationWithCameras("").has_readout);
}

// Of two configurations, of which one includes the other, the latter's calibration or readout counts.
double includedReadout(const std::string& base, const std::string& text) {
  const TemporaryFolder folder;
  folder.write("known.yaml", "width: 640\nheight: 480\nfx: 500\nfy: 501\ncx: 320\ncy: 240\n");
  folder.write("base.yaml", base);
  const Configuration read = readConfiguration(folder.write("file.yaml", "include: base.yaml\n" + text));
  EXPECT_EQ(configurationWithCameras(formatConfiguration(read)).camera, read.camera);
  return read.camera.value().readout_s;
}

TEST(ConfigurationCamera, AReadoutBesideACalibrationIsOfThatOne) {
  const std::string known = "camera: {calibration: known.yaml}\n", alone = "camera: {readout: 0.02}\n";
  const std::string both = "camera: {calibration: known.yaml, readout: 0.01}\n";
  EXPECT_EQ(includedReadout(known, alone), 0.02);
  EXPECT_EQ(includedReadout(alone, known), 0.02);
  EXPECT_EQ(includedReadout(both, alone), 0.02);
  EXPECT_EQ(includedReadout(alone, both), 0.01);
  EXPECT_EQ(includedReadout(both, known), 0);
}

TEST(ConfigurationCamera, WrongReadoutsAreRefused) {
  const std::string beside_it = calibration_text + ", readout: ",
                    beside_file = "calibration: cameras/known.yaml, readout: ";
  for (const std::string& begin : {std::string("readout: "), beside_it, beside_file}) {
    for (const char* value : {"0.21", "-0.21", ".nan", "nan", ".inf", "20ms", "[0.02]", "~"}) {
      expectCameraRefused("camera: {" + begin + value + "}\n", "file.yaml:1: camera.readout: ");
    }
    expectCameraRefused("camera: {" + begin + "20}\n", "-0.2 to 0.2 s");
  }
}

TEST(ConfigurationCamera, OfTheSizeAloneALensIsPresumed) {
  for (const char* readout : {"", ", readout: 0.02"}) {
    const Configuration configuration =
        configurationWithCameras(std::string("camera: {width: 480, height: 640") + readout + "}\n");
    ASSERT_TRUE(configuration.camera);
    EXPECT_EQ(configuration.camera->fx, 512);
    EXPECT_EQ(configuration.camera->fy, 512);
    EXPECT_EQ(configuration.camera->cx, 239.5);
    EXPECT_EQ(configuration.camera->cy, 319.5);
    EXPECT_TRUE(configuration.settings.mapping.camera_finding.lens_is_presumed);
    EXPECT_NE(presumedLens(configuration).find("a focal length of 512 px is presumed (64 degrees"), std::string::npos)
        << presumedLens(configuration);
    // So a recording says it, too, and is repeated the same.
    const std::string written = formatConfiguration(configuration);
    const Configuration again = configurationWithCameras(written);
    EXPECT_TRUE(again.settings.mapping.camera_finding.lens_is_presumed) << written;
    EXPECT_EQ(*again.camera, *configuration.camera);
    EXPECT_EQ(again.has_readout, configuration.has_readout);
  }
  const Configuration calibrated = configurationWithCameras("camera: {" + calibration_text + "}\n");
  EXPECT_FALSE(calibrated.settings.mapping.camera_finding.lens_is_presumed);
  EXPECT_EQ(presumedLens(calibrated), "");
  expectCameraRefused("camera: {width: 640, height: 480, fx: 500}\n", "camera.fy is missing");
  expectCameraRefused("camera: {width: 640, height: 480, model: kannala_brandt}\n", "camera.fx is missing");
  expectCameraRefused("camera: {width: 640, height: 480, k1: 0.1}\n", "camera.fx is missing");
  const std::string size = "camera: {width: 640, height: 480}\n", never = "camera_finding: {enabled: false}\n";
  expectCameraRefused(size + never, "file.yaml:2: camera_finding.enabled: expected true");
  expectCameraRefused(never + size, "file.yaml:2: camera_finding.enabled: expected true");
}

TEST(ConfigurationCamera, ACalibrationCountsAlsoWhereAnIncludedFileHasTheSizeAlone) {
  for (const std::string& given : {std::string("calibration: known.yaml"), calibration_text}) {
    const TemporaryFolder folder;
    folder.write("known.yaml", "width: 640\nheight: 480\nfx: 500\nfy: 501\ncx: 320\ncy: 240\n");
    folder.write("base.yaml", "camera: {width: 640, height: 480}\n");
    const Configuration read =
        readConfiguration(folder.write("file.yaml", "include: base.yaml\ncamera: {" + given + "}\n"));
    EXPECT_FALSE(read.settings.mapping.camera_finding.lens_is_presumed) << given;
    EXPECT_EQ(read.camera->fx, 500);
    EXPECT_EQ(configurationWithCameras(formatConfiguration(read)).camera, read.camera);
  }
}

TEST(ConfigurationCamera, WrongCalibrationsAreRefused) {
  expectCameraRefused("camera: {width: 640}\n", "camera.height is missing");
  expectCameraRefused("camera: {" + calibration_text + ", k4: 1}\n", "camera.k4 is no coefficient");
  expectCameraRefused("camera: {" + calibration_text + ", model: fish}\n", "camera.model: expected");
  expectCameraRefused("camera: {" + calibration_text + ", colour: 1}\n", "file.yaml:1: camera.colour is not a key");
  expectCameraRefused("camera: {" + calibration_text + ", calibration: cameras/known.yaml}\n", "in a file already");
  expectCameraRefused("camera: {calibration: cameras/known.yaml, readout: 0.02, k1: 0.1}\n",
                      "camera.k1: the calibration is in");
  for (const char* value : {"-500", "0", ".nan", ".inf", "wide", "[500]", "~"}) {
    expectCameraRefused(
        std::string("camera: {width: 640, height: 480, fx: ") + value + ", fy: 500, cx: 320, cy: 240}\n",
        "file.yaml:1: camera.fx: ");
  }
  expectCameraRefused("camera: {width: 640, height: 480, fx: 500, fy: 500, cx: 320, cy: 640}\n", "outside the image");
  expectCameraRefused("camera:\n  calibration: cameras/none.yaml\n", "file.yaml:2: camera.calibration: ");
  expectCameraRefused("camera:\n  calibration: cameras/bad.yaml\n", "fx");
  expectCameraRefused("camera:\n  calibration: [1]\n", "the path of a file is expected");
}

TEST(ConfigurationCamera, BothFormsOfThePoseMeanTheSame) {
  const Configuration matrix = configurationWithCameras(
      "camera:\n  body_T_camera: [[0, 0, 1, 0.1], [-1, 0, 0, 0.2], [0, -1, 0, 0.3], [0, 0, 0, 1]]\n");
  const Configuration flat =
      configurationWithCameras("camera:\n  body_T_camera: [0, 0, 1, 0.1, -1, 0, 0, 0.2, 0, -1, 0, 0.3, 0, 0, 0, 1]\n");
  const Configuration mapping = configurationWithCameras(
      "camera:\n  body_T_camera: {translation: [0.1, 0.2, 0.3], quaternion: [0.5, -0.5, 0.5, -0.5]}\n");
  for (const Configuration* read : {&matrix, &flat, &mapping}) {
    EXPECT_FALSE(read->camera);
    // The camera's z axis (forward) is the robot's x axis.
    EXPECT_TRUE((read->body_T_camera * Eigen::Vector3d(0, 0, 1)).isApprox(Eigen::Vector3d(1.1, 0.2, 0.3), 1e-12));
    EXPECT_TRUE((read->body_T_camera * Eigen::Vector3d(1, 0, 0)).isApprox(Eigen::Vector3d(0.1, -0.8, 0.3), 1e-12));
  }
}

TEST(ConfigurationCamera, WrongPosesAreRefused) {
  const std::string begin = "camera:\n  body_T_camera: ";
  expectCameraRefused(begin + "[1, 2, 3]\n", "16 finite numbers");
  expectCameraRefused(begin + "[1, 0, 0, .nan, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n", "16 finite numbers");
  expectCameraRefused(begin + "[2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n", "not a rotation");
  expectCameraRefused(begin + "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1]\n", "not a rotation");
  expectCameraRefused(begin + "[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 2]\n", "last row");
  expectCameraRefused(begin + "{translation: [0, 0, 0]}\n", "both translation and quaternion");
  expectCameraRefused(begin + "{translation: [0, 0], quaternion: [1, 0, 0, 0]}\n", "three finite numbers");
  expectCameraRefused(begin + "{translation: [0, 0, 0], quaternion: [0, 0, 0, 0]}\n", "length is not 1");
  expectCameraRefused(begin + "{translation: [0, 0, 0], quaternion: [1, 0, 0, 0], unit: mm}\n",
                      "only translation and quaternion");
  expectCameraRefused(begin + "forward\n", "file.yaml:2: camera.body_T_camera: a 4x4 matrix");
}

TEST(ConfigurationCamera, APlaceOnTheRobotIsReadBackToTheLastBit) {
  for (const char* quaternion : {"[0.1, 0.7, -0.3, 0.64]", "[0.31, -0.95, 0.01, 0.0362]", "[0.577, 0.577, 0.578, 0]"}) {
    const Configuration first = configurationWithCameras(
        "camera: {body_T_camera: {translation: [0.1, 0, 1e-9], quaternion: " + std::string(quaternion) + "}}\n");
    const Configuration again = configurationWithCameras(formatConfiguration(first));
    EXPECT_EQ(again.body_T_camera.rotation.coeffs(), first.body_T_camera.rotation.coeffs()) << quaternion;
  }
}

std::string pgm(int width, int height, int grey) {
  return "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n255\n" +
         std::string(static_cast<std::size_t>(width * height / 2), static_cast<char>(grey)) +
         std::string(static_cast<std::size_t>(width * height / 2), '\0');
}

// A folder with calibrations of 640 x 480 and 64 x 48 pixels, and masks of both sizes.
class MaskedCamera : public ::testing::Test {
 protected:
  MaskedCamera() {
    folder_.write("large.yaml", "width: 640\nheight: 480\nfx: 500\nfy: 501\ncx: 320\ncy: 240\n");
    folder_.write("small.yaml", "width: 64\nheight: 48\nfx: 50\nfy: 50\ncx: 32\ncy: 24\n");
    folder_.write("masks/large.pgm", pgm(640, 480, 255));
    folder_.write("masks/small.pgm", pgm(64, 48, 255));
    folder_.write("masks/black.pgm", pgm(640, 480, 0));
  }
  Configuration read(const std::string& text) const { return readConfiguration(folder_.write("file.yaml", text)); }
  void expectCameraRefused(const std::string& text, const std::string& part) const {
    try {
      read(text);
      ADD_FAILURE() << "not refused: " << text;
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).rfind(folder_.path("file.yaml") + ":", 0), 0U) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  }

  const TemporaryFolder folder_;
};

TEST_F(MaskedCamera, IsReadRelativeToTheFile) {
  const Configuration found = read("camera: {calibration: large.yaml, mask: masks/large.pgm}\n");
  ASSERT_TRUE(found.camera->mask);
  EXPECT_DOUBLE_EQ(maskedShare(*found.camera->mask), 0.5);
  EXPECT_FALSE(read("camera: {calibration: large.yaml}\n").camera->mask);
  EXPECT_TRUE(read("camera: {" + calibration_text + ", mask: masks/large.pgm}\n").camera->mask);
}

TEST_F(MaskedCamera, AMaskByItselfIsOfWhateverCalibrationIsTaken) {
  const Configuration found = read("camera: {mask: masks/large.pgm}\n");
  EXPECT_FALSE(found.camera);
  Camera beside;
  beside.width = 640;
  beside.height = 480;
  EXPECT_EQ(asConfigured(beside, found).mask, found.mask);
  beside.width = 320;
  try {
    asConfigured(beside, found);
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()), folder_.path("file.yaml") + ": camera.mask: " + found.mask_path +
                                             " is 640 x 480 pixels, expected the camera's size, 320 x 480");
  }
}

TEST_F(MaskedCamera, MayBeIncludedOrIncludeTheCalibration) {
  folder_.write("base.yaml", "camera: {mask: masks/large.pgm}\n");
  EXPECT_TRUE(read("include: base.yaml\ncamera: {calibration: large.yaml}\n").camera->mask);
  folder_.write("base.yaml", "camera: {calibration: large.yaml}\n");
  EXPECT_TRUE(read("include: base.yaml\ncamera: {mask: masks/large.pgm}\n").camera->mask);
}

TEST_F(MaskedCamera, TheEffectiveConfigurationNamesIt) {
  const Configuration found = read("camera: {calibration: large.yaml, mask: masks/large.pgm}\n");
  const TemporaryFolder elsewhere;
  const Configuration again = readConfiguration(elsewhere.write("file.yaml", formatConfiguration(found)));
  EXPECT_EQ(again.mask_path, found.mask_path);
  ASSERT_TRUE(again.camera->mask);
  EXPECT_NE(formatRecordedConfiguration(found).find("  mask: mask.png\n"), std::string::npos);
  EXPECT_EQ(formatConfiguration(read("camera: {calibration: large.yaml}\n")).find("mask"), std::string::npos);
}

TEST_F(MaskedCamera, WrongMasksAreRefusedByFileLineAndKey) {
  const std::string camera = "camera:\n  calibration: large.yaml\n  mask: ";
  expectCameraRefused(camera + "masks/small.pgm\n", ":3: camera.mask: ");
  expectCameraRefused(camera + "masks/small.pgm\n", "is 64 x 48 pixels, expected the camera's size, 640 x 480");
  expectCameraRefused(camera + "masks/black.pgm\n", ":3: camera.mask: ");
  expectCameraRefused(camera + "masks/black.pgm\n", "all of it is black; expected black only where");
  expectCameraRefused(camera + "masks/none.png\n", "no such file; expected an image of the camera's size");
  expectCameraRefused(camera + "large.yaml\n", "is no PNG, JPEG");
  expectCameraRefused(camera + "\n", "camera.mask: the path of an image is expected");
  expectCameraRefused(camera + "[a]\n", ":3: camera.mask: the path of an image is expected");
  folder_.write("base.yaml", "camera: {mask: masks/small.pgm}\n");
  expectCameraRefused("include: base.yaml\ncamera: {calibration: large.yaml}\n", "camera.mask: ");
}

}  // namespace
}  // namespace edgeslam
