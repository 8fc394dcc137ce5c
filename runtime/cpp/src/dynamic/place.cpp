// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/dynamic/place.hpp"

#include "rr/error.hpp"

namespace rr::dynamic {

std::string Place::text() const {
  if (step_ == Step::subject) return std::string(name_);
  std::string text = outer_->text();
  const bool is_first = outer_->step_ == Step::subject;
  if (is_first && !text.empty()) text += ", ";
  switch (step_) {
    case Step::field:
      text += (is_first ? "field " : ".") + std::string(name_);
      break;
    case Step::item:
      text += (is_first ? "item [" : "[") + std::to_string(index_) + "]";
      break;
    default:
      text += (is_first ? "item [\"" : "[\"") + std::string(name_) + "\"]";
  }
  return text;
}

void Place::fail(const std::string& what) const {
  const std::string place = text();
  throw Error(ErrorCode::data_type_mismatch, place.empty() ? what : place + ": " + what);
}

}  // namespace rr::dynamic
