// SPDX-License-Identifier: Apache-2.0
#include "rr/error.hpp"

#include <utility>

#include "rr/varvalue.hpp"

namespace rr {

Error::Error(ErrorCode code, std::string message)
    : Error(code, std::string(error_name(code)), std::move(message)) {}

Error::Error(ErrorCode code, std::string name, std::string message, std::string subname)
    : code_(code),
      name_(std::move(name)),
      message_(std::move(message)),
      subname_(std::move(subname)),
      what_(name_.empty() ? message_ : name_ + ": " + message_) {}

Error::Error(ErrorCode code, std::string name, std::string message, std::string subname,
             const VarValue& parameter)
    : Error(code, std::move(name), std::move(message), std::move(subname)) {
  if (!parameter.is_null()) parameter_ = std::make_shared<const VarValue>(parameter);
}

Error::~Error() = default;

const VarValue& Error::parameter() const {
  static const VarValue null;
  return parameter_ ? *parameter_ : null;
}

}  // namespace rr
