// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/dynamic/texts.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

namespace rr::conformance {
namespace {

// What a line of a definition says behind this word; nothing when it begins with another.
std::string name_behind(const std::string& word, const std::string& line) {
  std::istringstream words(line);
  std::string first;
  std::string name;
  return words >> first >> name && first == word ? name : std::string();
}

}  // namespace

std::vector<std::string> read_folder(const std::string& folder) {
  std::vector<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return texts;
}

std::vector<std::string> with_imports(const std::vector<std::string>& texts,
                                      const std::string& service) {
  std::vector<std::string> result;
  std::set<std::string> wanted = {service};
  std::set<std::string> found;
  for (bool is_more = true; is_more;) {
    is_more = false;
    for (const std::string& text : texts) {
      std::istringstream lines(text);
      std::string name;
      std::vector<std::string> imports;
      for (std::string line; std::getline(lines, line);) {
        if (name.empty()) name = name_behind("service", line);
        if (const std::string import = name_behind("import", line); !import.empty()) {
          imports.push_back(import);
        }
      }
      if (wanted.count(name) == 0 || !found.insert(name).second) continue;
      wanted.insert(imports.begin(), imports.end());
      result.push_back(text);
      is_more = true;
    }
  }
  return result;
}

}  // namespace rr::conformance
