// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <string>

namespace rr::gateway::matrix {

/// What each word at the beginning of a line does; its result is written as the answer.
using Commands = std::map<std::string, std::function<std::string(std::istringstream&)>>;

/// A command that takes one value, and answers with `done`.
template <class Value, class Function>
auto with_value(const char* done, const Function& function) {
  return [done, function](std::istringstream& words) -> std::string {
    Value value{};
    words >> value;
    function(value);
    return done;
  };
}

/// Says `ready` with a text, then answers each line of standard input with one of standard output,
/// until its end.
inline void take_commands(const std::string& ready, const Commands& commands) {
  std::cout << "ready " << ready << std::endl;
  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream words(line);
    std::string word;
    words >> word;
    const auto command = commands.find(word);
    std::cout << (command == commands.end() ? "unknown command: " + word : command->second(words))
              << std::endl;
  }
}

}  // namespace rr::gateway::matrix
