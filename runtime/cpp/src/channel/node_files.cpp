// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/node_files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "rr/error.hpp"

namespace rr::channel {
namespace {

constexpr std::size_t largest_info = 16 * 1024;
constexpr std::string_view blanks = " \t\r";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

// Locks belong to the open file, not to the process: two nodes of one process exclude each other
// too, and nobody who reads the file and closes it again ends them.
struct flock whole_file() {
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  return lock;
}

bool is_key(std::string_view text) {
  return !text.empty() && text.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyz"
                              "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                              "0123456789_+.-") == std::string_view::npos;
}

}  // namespace

HeldFile::HeldFile(const std::string& path, std::string_view what)
    : path_(path),
      file_(open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW, 0640)) {
  if (!file_) {
    throw Error(ErrorCode::system_resource_error, "`" + path + "`: " + std::strerror(errno));
  }
  struct flock lock = whole_file();
  if (fcntl(file_.get(), F_OFD_SETLK, &lock) != 0) {
    throw Error(ErrorCode::invalid_operation,
                std::string(what) + " is in use: somebody has locked `" + path + "`");
  }
  fchmod(file_.get(), 0640);
}

void HeldFile::write(std::string_view text) const {
  if (ftruncate(file_.get(), 0) != 0 ||
      ::write(file_.get(), text.data(), text.size()) != static_cast<ssize_t>(text.size())) {
    throw Error(ErrorCode::system_resource_error, "`" + path_ + "`: " + std::strerror(errno));
  }
}

InfoText parse_info(std::string_view text) {
  InfoText result;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    const std::string_view key = trimmed(line.substr(0, colon));
    if (is_key(key)) result.emplace(key, trimmed(line.substr(colon + 1)));
  }
  return result;
}

std::optional<InfoText> read_info(const std::string& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW));
  struct stat found {};
  if (!file || fstat(file.get(), &found) != 0 || !S_ISREG(found.st_mode)) return std::nullopt;
  std::string text(largest_info + 1, '\0');
  const ssize_t size = read(file.get(), text.data(), text.size());
  if (size <= 0 || static_cast<std::size_t>(size) > largest_info) return std::nullopt;
  text.resize(static_cast<std::size_t>(size));
  return parse_info(text);
}

bool is_locked(const std::string& path) {
  const Descriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW));
  struct flock lock = whole_file();
  return file && fcntl(file.get(), F_OFD_GETLK, &lock) == 0 && lock.l_type != F_UNLCK;
}

NodeFiles::NodeFiles(const NodeFolder& folder, const NodeId& id, const std::string& name,
                     const std::string& socket, const std::string& nonce)
    : text_{{"nodeid", id.text_with_braces()},
            {"pid", std::to_string(getpid())},
            {"socket", socket},
            {"username", own_user_name()},
            {"ServiceStateNonce", nonce}} {
  const std::string by_id = folder.base + "/by-nodeid/" + id.text();
  const std::string what_id = "the node id " + id.text();
  info_.emplace_back(by_id + ".info", what_id);
  pid_.emplace_back(by_id + ".pid", what_id);
  if (!name.empty()) {
    text_["nodename"] = name;
    const std::string by_name = folder.base + "/by-nodename/" + name;
    const std::string what_name = "the node name `" + name + "`";
    info_.emplace_back(by_name + ".info", what_name);
    pid_.emplace_back(by_name + ".pid", what_name);
  }
  for (const HeldFile& file : pid_) file.write(text_["pid"]);
  write_info();
}

NodeFiles::~NodeFiles() {
  try {
    for (const HeldFile& file : info_) file.write({});
    for (const HeldFile& file : pid_) file.write({});
  } catch (const Error&) {
    // The lock goes in any case, by which others know.
  }
}

void NodeFiles::set_nonce(const std::string& nonce) {
  text_["ServiceStateNonce"] = nonce;
  write_info();
}

void NodeFiles::write_info() const {
  std::string text;
  for (const auto& [key, value] : text_) text.append(key).append(": ").append(value).append("\n");
  for (const HeldFile& file : info_) file.write(text);
}

void clean_up(const NodeFolder& folder) {
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder.base + "/by-nodeid", error)) {
    if (entry.path().extension() != ".info") continue;
    const std::string path = entry.path().string();
    const auto info = read_info(path);
    if (!info || !info->contains("socket")) continue;
    const std::string& socket = info->at("socket");
    // Only what such a node has made there.
    const bool is_ours =
        std::filesystem::path(socket).parent_path() == folder.sockets && socket.ends_with(".sock");
    if (!is_ours || is_locked(path)) continue;
    std::filesystem::remove(socket, error);
  }
}

namespace {

std::optional<std::string> socket_in(const NodeFolder& folder, const Url& url) {
  const std::string by_name = folder.base + "/by-nodename/" + url.node_name + ".info";
  if (url.node_id.is_any()) {
    const auto info = read_info(by_name);
    if (!info || !info->contains("socket")) return std::nullopt;
    const auto name = info->find("nodename");
    if (name != info->end() && name->second != url.node_name) return std::nullopt;
    return info->at("socket");
  }
  const auto info = read_info(folder.base + "/by-nodeid/" + url.node_id.text() + ".info");
  if (!info || !info->contains("socket")) return std::nullopt;
  if (url.node_name.empty()) return info->at("socket");
  const auto named = read_info(by_name);
  if (!info->contains("nodename") || info->at("nodename") != url.node_name || !named ||
      !named->contains("socket") || named->at("socket") != info->at("socket")) {
    return std::nullopt;
  }
  return info->at("socket");
}

}  // namespace

std::vector<std::string> find_sockets(const LocalOptions& options, const Url& url) {
  if (url.path.size() > 1) return {url.path};
  if (url.node_id.is_any() && url.node_name.empty()) {
    throw Error(ErrorCode::invalid_argument,
                "a local URL needs `nodeid`, `nodename`, or the path of a socket");
  }
  std::vector<std::string> sockets;
  for (const NodeFolder& folder : folders_for_host(options, url.host)) {
    if (auto socket = socket_in(folder, url)) sockets.push_back(std::move(*socket));
  }
  return sockets;
}

}  // namespace rr::channel
