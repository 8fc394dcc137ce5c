// SPDX-License-Identifier: Apache-2.0
// The list of backends.
#include <algorithm>

#include "compiler/backends/arduino/backend.hpp"
#include "compiler/backends/backend.hpp"
#include "compiler/backends/cbus/backend.hpp"
#include "compiler/backends/cpp/backend.hpp"
#include "compiler/backends/csharp/backend.hpp"
#include "compiler/backends/matlab/backend.hpp"
#include "compiler/backends/typescript/backend.hpp"

namespace robdef {

const std::vector<const Backend*>& backends() {
  static const cpp::CppBackend cpp;
  static const csharp::CSharpBackend csharp;
  static const matlab::MatlabBackend matlab;
  static const arduino::ArduinoBackend arduino;
  static const cbus::CBusBackend cbus;
  static const typescript::TypeScriptBackend typescript;
  static const std::vector<const Backend*> all{&cpp,     &csharp, &matlab,
                                               &arduino, &cbus,   &typescript};
  return all;
}

const Backend* find_backend(std::string_view name) {
  const auto found = std::ranges::find(backends(), name, &Backend::name);
  return found == backends().end() ? nullptr : *found;
}

}  // namespace robdef
