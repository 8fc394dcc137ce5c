// SPDX-License-Identifier: Apache-2.0
#include "rr/latch.hpp"

namespace rr {

std::string Latch::message() const {
  if (!failed()) return {};
  std::string text = what_;
  if (element_[0] != '\0') {
    text += ": element `";
    text += element_;
    text += '`';
  }
  return text;
}

}  // namespace rr
