// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/codec/captures.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <stdexcept>

#include "rr/writer.hpp"

namespace rr::captures {
namespace {

using nlohmann::json;

json load(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw std::runtime_error("no file " + path.string());
  return json::parse(file);
}

std::filesystem::path folder() { return RR_CAPTURES_DIR; }

void append_hex(std::string_view hex, std::vector<std::byte>& bytes) {
  int high = -1;
  for (const char c : hex) {
    if (c == ' ' || c == '\n') continue;
    const int digit = c >= 'a' ? c - 'a' + 10 : c - '0';
    if (digit < 0 || digit > 15) throw std::runtime_error("not hexadecimal");
    if (high < 0) {
      high = digit;
    } else {
      bytes.push_back(static_cast<std::byte>(high * 16 + digit));
      high = -1;
    }
  }
  if (high >= 0) throw std::runtime_error("odd number of digits");
}

// Hexadecimal text with the three kinds of {...} in it.
class Expander {
 public:
  Expander() {
    const json blobs = load(folder() / "blobs.json");
    for (const auto& [name, text] : blobs.items()) {
      if (text.is_string()) blobs_[name] = text;
    }
  }

  [[nodiscard]] std::vector<std::byte> bytes(std::string_view text) const {
    std::vector<std::byte> result;
    while (!text.empty()) {
      const std::size_t open = text.find('{');
      append_hex(text.substr(0, open), result);
      if (open == std::string_view::npos) break;
      const std::size_t close = text.find('}', open);
      append(text.substr(open + 1, close - open - 1), result);
      text.remove_prefix(close + 1);
    }
    return result;
  }

 private:
  void append(std::string_view name, std::vector<std::byte>& result) const {
    if (name == "ep") {
      result.insert(result.end(), 4, std::byte{7});
    } else if (name.size() > 3 && name[2] == '*') {
      const auto times = std::stoul(std::string(name.substr(3)));
      result.insert(result.end(), times, from_hex(name.substr(0, 2)).front());
    } else {
      const std::string& blob = blobs_.at(std::string(name));
      const auto* data = reinterpret_cast<const std::byte*>(blob.data());
      result.insert(result.end(), data, data + blob.size());
    }
  }

  std::map<std::string, std::string> blobs_;
};

// Lists in lists in the value of the property `any`, a number innermost.
std::vector<std::byte> nested_lists(MessageVersion version, std::size_t depth) {
  Writer writer;
  writer.reset(version);
  const double innermost = 1.0;
  writer.prepend_bytes(&innermost, sizeof innermost);
  writer.element(ElementName(0), ElementType::double_, {}, 1, 0);
  for (std::size_t i = 1; i < depth; ++i) {
    writer.element(ElementName(0), ElementType::list, {}, 1, 0);
  }
  writer.element("value", ElementType::list, {}, 1, 0);
  writer.entry({.type = EntryType::property_set_req,
                .service_path = "conformance.props",
                .member = "any",
                .request_id = 2,
                .error = 0,
                .metadata = {}},
               1, 0);
  writer.message({}, 1);
  return writer.copy();
}

MessageVersion version_of(const json& object) {
  return object.at("message_version") == 2 ? MessageVersion::v2 : MessageVersion::v4;
}

}  // namespace

std::vector<std::byte> from_hex(std::string_view hex) {
  std::vector<std::byte> bytes;
  append_hex(hex, bytes);
  return bytes;
}

std::vector<Frame> frames() { return frames(".json"); }

std::vector<Frame> frames(std::string_view ending) {
  std::vector<std::filesystem::path> paths;
  for (const auto& file : std::filesystem::directory_iterator(folder() / "scenarios")) {
    const std::string name = file.path().filename().string();
    if (name.ends_with(ending) && !name.starts_with("websocket.")) paths.push_back(file.path());
  }
  std::sort(paths.begin(), paths.end());
  const Expander expander;
  std::vector<Frame> result;
  for (const auto& path : paths) {
    json scenario = load(path);
    for (json& frame : scenario.at("frames")) {
      result.push_back({path.stem().string() + " frame " + frame.at("n").dump(),
                        version_of(scenario), scenario.at("string_table").get<bool>(),
                        expander.bytes(frame.at("hex").get<std::string>()),
                        std::move(frame.at("decoded"))});
    }
  }
  return result;
}

std::vector<Value> values(MessageVersion version) {
  const char* name = version == MessageVersion::v2 ? "values-v2.json" : "values-v4.json";
  const Expander expander;
  std::vector<Value> result;
  const json file = load(folder() / name);
  for (const json& value : file.at("values")) {
    if (!value.contains("hex")) continue;  // refused by the reference
    result.push_back({value.at("name"), expander.bytes(value.at("hex").get<std::string>())});
  }
  return result;
}

std::vector<Malformed> malformed() {
  const Expander expander;
  std::vector<Malformed> result;
  const json file = load(folder() / "malformed.json");
  for (const json& item : file.at("cases")) {
    const MessageVersion version = version_of(item);
    std::vector<std::byte> bytes;
    if (item.contains("hex")) {
      bytes = expander.bytes(item.at("hex").get<std::string>());
    } else {
      bytes = nested_lists(version, item.at("recipe").at("nested lists").get<std::size_t>());
    }
    result.push_back({item.at("name"), version, item.at("result"), std::move(bytes)});
  }
  return result;
}

}  // namespace rr::captures
