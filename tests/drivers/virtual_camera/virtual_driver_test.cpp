#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <mutex>
#include <thread>

#include "drivers/virtual_camera/virtual_device.hpp"
#include "tests/drivers/virtual_camera/taken_images.hpp"
#include "tests/test_files.hpp"

// Functions that OpenNI2 calls in a driver library, by their names. NOLINTBEGIN(readability-identifier-naming)
extern "C" {
void oniDriverCreate(OniDriverServices* services);
void oniDriverDestroy();
OniStatus oniDriverInitialize(oni::driver::DeviceConnectedCallback connected,
                              oni::driver::DeviceDisconnectedCallback disconnected,
                              oni::driver::DeviceStateChangedCallback changed, void* cookie);
oni::driver::DeviceBase* oniDriverDeviceOpen(const char* uri, const char* mode);
void oniDriverDeviceClose(oni::driver::DeviceBase* device);
void* oniDriverEnableFrameSync(oni::driver::StreamBase** streams, int count);
void oniDriverDisableFrameSync(void* group);
}
// NOLINTEND(readability-identifier-naming)

namespace houghstream::virtual_camera {
namespace {

/// The driver as OpenNI2 has it while this lives, and what it told OpenNI2.
class LoadedDriver {
 public:
  explicit LoadedDriver(const std::string& script) : file_(fresh_folder("virtual_driver") / "script") {
    write_text(file_, script);
    start(file_.string());
  }
  LoadedDriver(const LoadedDriver&) = delete;
  LoadedDriver& operator=(const LoadedDriver&) = delete;
  ~LoadedDriver() { oniDriverDestroy(); }

  void change(const std::string& script) const {
    write_text(file_.parent_path() / "fresh", script);
    std::filesystem::rename(file_.parent_path() / "fresh", file_);
  }

  /// Waits until the driver has told so much: "+URI " for each camera that came, "-URI " for each that went.
  std::string told(std::size_t length) {
    for (int i = 0; i < 1000 && words().size() < length; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return words();
  }

  OniStatus status = ONI_STATUS_ERROR;
  int errors = 0;

 private:
  void start(const std::string& script_file) {
    setenv("HOUGHSTREAM_VIRTUAL_CAMERA", script_file.c_str(), 1);
    services_.driverServices = this;
    services_.errorLoggerAppend = [](void* self, const char*, va_list) { ++static_cast<LoadedDriver*>(self)->errors; };
    oniDriverCreate(&services_);
    status = oniDriverInitialize(
        &came, &went, [](const OniDeviceInfo*, int, void*) {}, this);
  }

  static void ONI_CALLBACK_TYPE came(const OniDeviceInfo* info, void* self) {
    static_cast<LoadedDriver*>(self)->note("+" + std::string(info->uri) + " ");
  }
  static void ONI_CALLBACK_TYPE went(const OniDeviceInfo* info, void* self) {
    static_cast<LoadedDriver*>(self)->note("-" + std::string(info->uri) + " ");
  }

  void note(const std::string& word) {
    const std::lock_guard<std::mutex> lock(mutex_);
    words_ += word;
  }
  std::string words() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return words_;
  }

  std::filesystem::path file_;
  OniDriverServices services_{};
  std::mutex mutex_;
  std::string words_;
};

const char* const kFirst = "houghstream-virtual://1";
const char* const kSecond = "houghstream-virtual://2";

TEST(VirtualDriver, CamerasComeAndGoAsTheScriptSays) {
  LoadedDriver driver("serial AA01\nserial AA02\n");
  ASSERT_EQ(driver.status, ONI_STATUS_OK);
  const std::string both = "+houghstream-virtual://1 +houghstream-virtual://2 ";
  EXPECT_EQ(driver.told(both.size()), both);
  driver.change("plugged no\n");
  const std::string gone = both + "-houghstream-virtual://1 -houghstream-virtual://2 ";
  EXPECT_EQ(driver.told(gone.size()), gone);
  driver.change("serial AA01\nserial AA02\n");
  EXPECT_EQ(driver.told(gone.size() + both.size()), gone + both);
}

TEST(VirtualDriver, OpensACameraByItsUri) {
  const LoadedDriver driver("serial AA01\nserial AA02\nsize 64x48\n");
  oni::driver::DeviceBase* device = oniDriverDeviceOpen(kSecond, nullptr);
  ASSERT_NE(device, nullptr);
  char serial[16] = {};
  int size = sizeof(serial);
  EXPECT_EQ(device->getProperty(ONI_DEVICE_PROPERTY_SERIAL_NUMBER, serial, &size), ONI_STATUS_OK);
  EXPECT_STREQ(serial, "AA02");
  oniDriverDeviceClose(device);
  EXPECT_EQ(oniDriverDeviceOpen("houghstream-virtual://3", nullptr), nullptr);
}

TEST(VirtualDriver, TwoSizesOfEqualWidthAreTwoModes) {
  const LoadedDriver driver("size 64x36\nsize 64x48\n");
  oni::driver::DeviceBase* device = oniDriverDeviceOpen(kFirst, nullptr);
  ASSERT_NE(device, nullptr);
  OniSensorInfo* infos = nullptr;
  int count = 0;
  ASSERT_EQ(device->getSensorInfoList(&infos, &count), ONI_STATUS_OK);
  ASSERT_EQ(infos[0].numSupportedVideoModes, 2);
  for (int i = 0; i < 2; ++i) {
    oni::driver::StreamBase* stream = device->createStream(ONI_SENSOR_DEPTH);
    TakenImages taken(*stream);
    const OniVideoMode& mode = infos[0].pSupportedVideoModes[i];
    ASSERT_EQ(stream->setProperty(ONI_STREAM_PROPERTY_VIDEO_MODE, &mode, sizeof(mode)), ONI_STATUS_OK);
    float angle = 0.0F;
    int size = sizeof(angle);
    ASSERT_EQ(stream->getProperty(ONI_STREAM_PROPERTY_VERTICAL_FOV, &angle, &size), ONI_STATUS_OK);
    EXPECT_NEAR(0.5 * mode.resolutionY / std::tan(0.5 * angle), 52.5, 1e-3) << "pixels are square in each";
    stream->start();
    const auto images = taken.wait(1);
    stream->stop();
    ASSERT_FALSE(images.empty());
    EXPECT_EQ(images[0].image.size(), cv::Size(64, i == 0 ? 48 : 36));
    device->destroyStream(stream);
  }
  oniDriverDeviceClose(device);
}

TEST(VirtualDriver, SynchronisesTheStreamsOfACameraThatCan) {
  for (const bool able : {true, false}) {
    const LoadedDriver driver(able ? "size 64x48\n" : "size 64x48\ncan_sync no\n");
    oni::driver::DeviceBase* device = oniDriverDeviceOpen(kFirst, nullptr);
    ASSERT_NE(device, nullptr);
    oni::driver::StreamBase* stream = device->createStream(ONI_SENSOR_DEPTH);
    void* group = oniDriverEnableFrameSync(&stream, 1);
    EXPECT_EQ(group != nullptr, able);
    if (group != nullptr) oniDriverDisableFrameSync(group);
    EXPECT_EQ(oniDriverEnableFrameSync(&stream, 0), nullptr);
    device->destroyStream(stream);
    oniDriverDeviceClose(device);
  }
}

TEST(VirtualDriver, AScriptThatCannotBeReadIsAnErrorOfOpenNi) {
  const LoadedDriver misspelt("plogged no\n");
  EXPECT_EQ(misspelt.status, ONI_STATUS_ERROR);
  EXPECT_EQ(misspelt.errors, 1);
}

TEST(VirtualDriver, ASceneThatIsNotThereIsFoundOutWhenTheCameraIsOpened) {
  const LoadedDriver driver("scene /no/such/scene\n");
  EXPECT_EQ(driver.status, ONI_STATUS_OK);
  EXPECT_EQ(oniDriverDeviceOpen(kFirst, nullptr), nullptr);
  EXPECT_EQ(driver.errors, 1);
}

}  // namespace
}  // namespace houghstream::virtual_camera
