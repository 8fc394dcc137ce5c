// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>
#include <vector>

#include "conformance/harness/json.hpp"
#include "conformance/harness/stream.hpp"

namespace rr::conformance {

/// A language's runner: a process that reads requests and writes answers, one line of JSON each.
/// It ends when its input does.
class Runner {
 public:
  /// Starts `command` with `verb` as its last argument. Throws std::runtime_error.
  Runner(std::vector<std::string> command, const std::string& verb);
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;
  ~Runner();

  void tell(const Json& request);
  /// Nothing when no answer came in time. Throws std::runtime_error when the process has ended or
  /// writes something else than JSON.
  std::optional<Json> answer(Milliseconds limit);
  /// Both at once; throws std::runtime_error, also when no answer came in time.
  Json ask(const Json& request, Milliseconds limit = Milliseconds(20000));
  /// Asks for what has to succeed: also throws when the runner answers with an error.
  Json order(const Json& request);

 private:
  std::string name_;
  pid_t process_ = -1;
  Descriptor input_;
  Descriptor output_;
  std::string received_;
};

}  // namespace rr::conformance
