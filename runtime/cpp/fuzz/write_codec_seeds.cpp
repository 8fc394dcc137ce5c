// SPDX-License-Identifier: Apache-2.0
// Writes messages of the captures, one of each shape, as seeds: write_codec_seeds FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include "runtime/cpp/src/codec/captures.hpp"

namespace {

constexpr std::size_t longest_seed = 1000;

// What makes one message different from another for a codec: fields and types, but no contents.
std::string shape(const nlohmann::json& elements) {
  std::string text;
  for (const auto& element : elements) {
    text += element.at("type").dump() + '/' + element.value("flags", nlohmann::json(0)).dump();
    if (element.contains("elements")) text += '(' + shape(element.at("elements")) + ')';
    text += ' ';
  }
  return text;
}

std::string shape_of_message(const nlohmann::json& decoded) {
  std::string text = decoded.at("header").at("version").dump() +
                     decoded.at("header").value("flags", nlohmann::json(0)).dump();
  for (const auto& entry : decoded.at("entries")) {
    text += " [" + entry.value("flags", nlohmann::json(0)).dump() + ' ' +
            shape(entry.at("elements")) + ']';
  }
  return text;
}

void write(const std::filesystem::path& folder, std::size_t number,
           const std::vector<std::byte>& bytes) {
  std::filesystem::create_directories(folder);
  std::ofstream file(folder / ("seed" + std::to_string(number)), std::ios::binary);
  file.write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fputs("usage: write_codec_seeds FOLDER\n", stderr);
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  std::set<std::string> shapes;
  std::size_t number = 0;
  for (const rr::captures::Frame& frame : rr::captures::frames()) {
    if (frame.bytes.size() > longest_seed) continue;
    if (!shapes.insert(shape_of_message(frame.decoded)).second) continue;
    const bool is_v2 = frame.decoded.at("header").at("version") == 2;
    write(folder / (is_v2 ? "codec_v2" : "codec_v4"), number++, frame.bytes);
  }
  std::printf("%zu seeds\n", number);
  return 0;
}
