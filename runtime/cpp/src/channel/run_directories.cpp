// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/channel/run_directories.hpp"

#include <algorithm>
#include <array>
#include <system_error>

#include "rr/error.hpp"
#include "runtime/cpp/src/channel/directories.hpp"
#include "runtime/cpp/src/channel/texts.hpp"
#include "runtime/cpp/src/platform/files.hpp"
#include "runtime/cpp/src/platform/users.hpp"

namespace rr::channel {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& why) {
  throw Error(ErrorCode::system_resource_error, "`" + path + "`: " + why);
}

}  // namespace

bool is_user_name(std::string_view text) {
  return !text.empty() && is_letter(text.front()) &&
         std::all_of(text.begin(), text.end(),
                     [](char c) { return is_letter(c) || is_digit(c) || c == '_' || c == '-'; });
}

std::string system_run_directory(const LocalOptions& options) {
  return options.system_run_dir.empty() ? platform::system_run_folder().string()
                                        : options.system_run_dir;
}

std::string user_run_directory(const LocalOptions& options) {
  if (!options.user_run_dir.empty()) return options.user_run_dir;
  if (platform::is_system_process()) return system_run_directory(options) + "/root";
  return platform::user_run_folder().string();
}

NodeFolder private_folder(const LocalOptions& options) {
  const std::string run = user_run_directory(options);
  return {run + "/transport/local", run + "/socket", run, false, {.is_private = true}};
}

NodeFolder public_folder(const LocalOptions& options, std::string_view user) {
  const std::string run = system_run_directory(options);
  const std::string base = run + "/transport/local/" + std::string(user);
  return {base, base + "/socket", run, true, {.owner = platform::user_of(std::string(user))}};
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
  const std::array parts = {folder.base + "/by-nodeid", folder.base + "/by-nodename",
                            folder.sockets};
  if (!folder.is_public) {
    for (const std::string& part : parts)
      platform::make_trusted_folder(part, folder.rule, folder.run);
    return;
  }
  if (!platform::open_trusted_folder(folder.base, folder.rule)) {
    fail(folder.base, "it does not exist; the machine's administrator makes it for public nodes");
  }
  for (const std::string& part : parts) {
    const std::error_code error = platform::make_shared_folder(part);
    if (error) fail(part, error.message());
    platform::open_trusted_folder(part, folder.rule);  // one that was there may be another's
  }
}

}  // namespace rr::channel
