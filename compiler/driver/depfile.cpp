// SPDX-License-Identifier: Apache-2.0
#include "compiler/driver/depfile.hpp"

#include <string_view>

namespace robdef {

namespace {

std::string escaped(std::string_view path) {
  std::string text;
  for (const char letter : path) {
    if (letter == '$') text += '$';
    if (letter == ' ' || letter == '#') text += '\\';
    text += letter;
  }
  return text;
}

}  // namespace

std::string depfile_text(const std::vector<std::string>& targets,
                         const std::vector<std::string>& inputs) {
  std::string text;
  for (const std::string& target : targets) {
    if (!text.empty()) text += ' ';
    text += escaped(target);
  }
  text += ':';
  for (const std::string& input : inputs) text += " \\\n  " + escaped(input);
  return text + "\n";
}

}  // namespace robdef
