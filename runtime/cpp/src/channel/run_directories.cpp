// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/run_directories.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/directories.hpp"

namespace rr::channel {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw Error(ErrorCode::system_resource_error, "`" + path + "`: " + why);
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

void make_directory(const std::string& path, mode_t mode, bool is_exact) {
  if (mkdir(path.c_str(), mode) == 0) {
    // Without what the mask took away.
    if (is_exact && chmod(path.c_str(), mode) != 0) fail(path, std::strerror(errno));
    return;
  }
  if (errno != EEXIST) fail(path, std::strerror(errno));
}

void make_directories(const std::string& path) {
  constexpr mode_t usual = 0777;  // and the mask
  for (std::size_t at = path.find('/', 1);; at = path.find('/', at + 1)) {
    make_directory(path.substr(0, at), usual, false);
    if (at == std::string::npos) return;
  }
}

// What others could have made for us to walk into is refused.
void check_owner(const std::string& path) {
  struct stat found {};
  if (lstat(path.c_str(), &found) != 0) fail(path, std::strerror(errno));
  if (!S_ISDIR(found.st_mode)) fail(path, "it is no folder");
  if (found.st_uid != geteuid()) fail(path, "it belongs to another user");
  if ((found.st_mode & S_IWOTH) != 0) fail(path, "everybody may write to it");
}

}  // namespace

bool is_user_name(std::string_view text) {
  return !text.empty() && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(), [](char c) {
           return is_letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-';
         });
}

std::string system_run_directory(const LocalOptions& options) {
  return options.system_run_dir.empty() ? system_run_directory().string() : options.system_run_dir;
}

std::string user_run_directory(const LocalOptions& options) {
  if (!options.user_run_dir.empty()) return options.user_run_dir;
  if (geteuid() == 0) return system_run_directory(options) + "/root";
  return user_run_directory().string();
}

NodeFolder private_folder(const LocalOptions& options) {
  const std::string run = user_run_directory(options);
  return {run + "/transport/local", run + "/socket", false};
}

NodeFolder public_folder(const LocalOptions& options, std::string_view user) {
  const std::string base = system_run_directory(options) + "/transport/local/" + std::string(user);
  return {base, base + "/socket", true};
}

std::vector<NodeFolder> folders_for_host(const LocalOptions& options, std::string_view host) {
  const std::string own = own_user_name();
  if (host.empty() || host == "localhost") {
    return {private_folder(options), public_folder(options, own), public_folder(options, "root")};
  }
  constexpr std::string_view ending = "@localhost";
  const std::string_view user =
      host.ends_with(ending) ? host.substr(0, host.size() - ending.size()) : std::string_view();
  if (!is_user_name(user)) {
    throw Error(ErrorCode::invalid_argument,
                "the host of a local URL is `localhost` or `user@localhost`, not `" +
                    std::string(host) + "`");
  }
  if (user == own) return {private_folder(options), public_folder(options, own)};
  return {public_folder(options, user)};
}

void make_folder(const NodeFolder& folder) {
  constexpr mode_t shared = S_ISGID | 0750;
  if (!folder.is_public) {
    make_directories(folder.base);
    make_directories(folder.sockets);
    check_owner(folder.sockets);
    check_owner(folder.base);
  } else if (!std::filesystem::is_directory(folder.base)) {
    fail(folder.base, "it does not exist; the machine's administrator makes it for public nodes");
  }
  for (const std::string& part :
       {folder.base + "/by-nodeid", folder.base + "/by-nodename", folder.sockets}) {
    make_directory(part, folder.is_public ? shared : 0777, folder.is_public);
  }
}

}  // namespace rr::channel
