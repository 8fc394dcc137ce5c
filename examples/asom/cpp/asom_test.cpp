// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "examples/asom/cpp/instrument.hpp"
#include "examples/asom/cpp/sharpen.hpp"
#include "rr/node.hpp"

namespace asom {
namespace {

struct Served {
  rr::Node server;
  rr::Node client;
  rr::Service service =
      server.register_service("CameraHost", make_host(std::make_shared<Instrument>()));
  std::uint16_t port = server.listen_tcp(0, "127.0.0.1");
  rr::Client<host::CameraHostStub> root = client.connect<host::CameraHostStub>(
      "rr+tcp://127.0.0.1:" + std::to_string(port) + "?service=CameraHost");
};

TEST(Asom, ThePictureBecomesSharperAndNeverSharperThanTheSpecimen) {
  Served served;
  Instruments instruments(*served.root);
  instruments.point(0.75, -0.75);
  const Sharpened result = sharpen(instruments);
  EXPECT_GT(sharpness(result.sharp), 1.5 * sharpness(result.flat));
  EXPECT_LT(sharpness(result.sharp), sharpness(Microscope().ideal(0.75, -0.75)));
  EXPECT_EQ(instruments.expose().gray, result.sharp.gray) << "the mirror stays where it was best";
}

TEST(Asom, TheMirrorStandsWhenItsCallReturns) {
  Served served;
  const auto scanner = served.root->get_robdevice(0);
  EXPECT_GT(scanner->SetProperty("Angles", {0.5, -0.25}), 5) << "cycles that it took";
  const auto angles = scanner->GetProperty("Angles");
  EXPECT_NEAR(angles[0], 0.5, 1e-3);
  EXPECT_NEAR(angles[1], -0.25, 1e-3);
}

TEST(Asom, WhatIsOutOfReachIsRefused) {
  Served served;
  EXPECT_THROW(served.root->get_robdevice(0)->SetProperty("Angles", {2, 0}), rr::Error);
  EXPECT_THROW(served.root->get_robdevice(0)->SetProperty("Angle", {0, 0}), rr::Error);
  EXPECT_THROW(served.root->get_robdevice(1)->SetProperty("Actuators", {0}), rr::Error);
}

}  // namespace
}  // namespace asom
