// SPDX-License-Identifier: Apache-2.0
// How a program that uses a service is tested without it: the generated skeletons are interfaces,
// which GoogleMock implements, and the client reaches them in its own process.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "RobotCameraHost_interface.hpp"
#include "rr/error.hpp"
#include "rr/intra.hpp"
#include "rr/node.hpp"

namespace smart_room {
namespace {

namespace host = RobotCameraHost_interface;
using ::testing::ElementsAre;
using ::testing::Return;
using ::testing::Throw;

class MockDevice : public host::RobotDeviceSkeleton {
 public:
  MOCK_METHOD(std::string, get_Name, (), (override));
  MOCK_METHOD(void, set_Name, (const std::string& value), (override));
  MOCK_METHOD(rr::Array<double>, GetProperty, (const std::string& name), (override));
  MOCK_METHOD(std::int32_t, SetProperty, (const std::string& name, const rr::Array<double>& values),
              (override));
};

// What is tested: any function that takes a stub.
bool dim(host::RobotDeviceStub& lights) {
  try {
    return lights.SetProperty("SetRGBRange", {1, 6, 0.1, 0.1, 0.1}) == 0;
  } catch (const rr::Error&) {
    return false;
  }
}

class Mocked : public ::testing::Test {
 protected:
  Mocked() {
    service_.listen("rr+intra://");
    service_.register_service("lights", device_);
    lights_ =
        client_.connect<host::RobotDeviceStub>("rr+intra:///?nodename=test.room&service=lights");
  }

  std::shared_ptr<rr::IntraSpace> space_ = std::make_shared<rr::IntraSpace>();
  std::shared_ptr<MockDevice> device_ = std::make_shared<MockDevice>();
  rr::Node service_{{.name = "test.room", .intra = space_}};
  rr::Node client_{{.intra = space_}};
  rr::Client<host::RobotDeviceStub> lights_;
};

TEST_F(Mocked, DimmingSetsAllLampsAtOnce) {
  EXPECT_CALL(*device_, SetProperty("SetRGBRange", ElementsAre(1, 6, 0.1, 0.1, 0.1)))
      .WillOnce(Return(0));
  EXPECT_TRUE(dim(*lights_));
}

TEST_F(Mocked, DimmingSurvivesAServiceThatRefuses) {
  EXPECT_CALL(*device_, SetProperty)
      .WillOnce(Throw(rr::Error(rr::ErrorCode::invalid_argument, "no lamps")));
  EXPECT_FALSE(dim(*lights_));
}

}  // namespace
}  // namespace smart_room
