// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Robdef.h>

#include "example_echo/example_echo.h"

class Echo {
 public:
  rr::Status getValue(double& value) {
    value = value_;
    return rr::Status::Ok;
  }
  rr::Status setValue(double value) {
    value_ = value;
    return rr::Status::Ok;
  }
  rr::Status getCount(uint32_t& value) {
    value = count_;
    return rr::Status::Ok;
  }
  rr::Status add(double a, double b, double& result) {
    ++count_;
    hasAdded_ = true;
    result = a + b;
    return rr::Status::Ok;
  }
  rr::Status wait(uint16_t time) {
    delay(time);
    return rr::Status::Ok;
  }
  rr::Status receiveCounts(uint32_t packet) {
    packet_ = packet;
    hasPacket_ = true;
    return rr::Status::Ok;
  }
  /// Negative questions are asked two seconds later.
  rr::Status ask(double question) {
    question_ = question;
    askAt_ = static_cast<uint16_t>(millis() + (question < 0 ? 2000 : 0));
    hasQuestion_ = true;
    return rr::Status::Ok;
  }
  void answeredDoubled(rr::Status status, double result) {
    value_ = status == rr::Status::Ok ? result : -static_cast<double>(status);
  }
  bool takePacket(uint32_t& packet) {
    packet = packet_;
    const bool result = hasPacket_;
    hasPacket_ = false;
    return result;
  }
  bool takeQuestion(double& question) {
    question = question_;
    const uint16_t late = static_cast<uint16_t>(millis() - askAt_);
    const bool result = hasQuestion_ && late < 0x8000;
    if (result) hasQuestion_ = false;
    return result;
  }

  /// True once after each add().
  bool hasAdded() {
    const bool result = hasAdded_;
    hasAdded_ = false;
    return result;
  }
  uint32_t count() const { return count_; }

 private:
  double value_ = 0;
  uint32_t count_ = 0;
  bool hasAdded_ = false;
  uint32_t packet_ = 0;
  double question_ = 0;
  uint16_t askAt_ = 0;
  bool hasPacket_ = false;
  bool hasQuestion_ = false;
};

/// What a sketch does besides polling its service.
template <class Service>
void sayWhatIsDue(Echo& echo, Service& service) {
  if (echo.hasAdded()) service.root().fireAdded(echo.count());
  uint32_t packet;
  if (echo.takePacket(packet)) {
    service.root().sendCounts(packet);
    service.root().sendCounts(packet + 1);
  }
  double question;
  if (echo.takeQuestion(question)) service.root().askDoubled(question);
}
