// SPDX-License-Identifier: Apache-2.0
#include "compiler/system/conventions.hpp"

#include <windows.h>
// After it:
#include <fcntl.h>
#include <io.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace robdef::system {
namespace {

UINT page_before = 0;

// The console outlives this program.
void restore_console() { SetConsoleOutputCP(page_before); }

// Whatever follows a point, and in letters of either case.
bool is_device(std::string_view stem) {
  while (stem.ends_with(' ')) stem.remove_suffix(1);
  const std::string word = one_spelling(std::string(stem));
  constexpr std::array single{"con", "prn", "aux", "nul", "conin$", "conout$"};
  if (std::ranges::find(single, word) != single.end()) return true;
  const bool is_numbered = word.starts_with("com") || word.starts_with("lpt");
  return is_numbered && word.size() == 4 && word[3] >= '0' && word[3] <= '9';
}

}  // namespace

void prepare_streams() {
  for (std::FILE* stream : {stdin, stdout, stderr}) _setmode(_fileno(stream), _O_BINARY);
  page_before = GetConsoleOutputCP();  // 0: there is no console
  if (page_before != 0 && page_before != CP_UTF8 && SetConsoleOutputCP(CP_UTF8) != FALSE) {
    std::atexit(restore_console);
  }
}

// A colon is a part of `C:\folder`.
std::string_view list_separators() { return ";"; }

std::string_view fault_of_name(std::string_view name) {
  if (name.find_first_of("<>:\"|?*") != name.npos)
    return "has a letter that Windows keeps for itself";
  if (name.ends_with('.') || name.ends_with(' ')) return "ends with what Windows leaves out";
  return is_device(name.substr(0, name.find('.'))) ? "is the name of a device" : "";
}

std::string one_spelling(std::string path) {
  for (char& letter : path) {
    if (letter >= 'A' && letter <= 'Z') letter = static_cast<char>(letter - 'A' + 'a');
  }
  return path;
}

}  // namespace robdef::system
