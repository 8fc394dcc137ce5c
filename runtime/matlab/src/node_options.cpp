// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/node_options.hpp"

#include <functional>
#include <map>
#include <string>

#include "rr/error.hpp"
#include "runtime/matlab/src/call.hpp"
#include "runtime/matlab/src/credentials.hpp"

namespace rr::matlab {
namespace {

using Read = std::function<void(const mxArray* given)>;

// What a struct has, each field by its function.
void read_fields(const mxArray* given, const std::string& subject,
                 const std::map<std::string, Read>& known) {
  if (!mxIsStruct(given) || count_of(given) != 1) {
    throw Error(ErrorCode::data_type_mismatch,
                subject + ": expected a struct, got " + described(given));
  }
  for (int i = 0; i < mxGetNumberOfFields(given); ++i) {
    const std::string name = mxGetFieldNameByNumber(given, i);
    const auto found = known.find(name);
    if (found == known.end()) {
      throw Error(ErrorCode::invalid_argument, subject + ": there is no `" + name + "`");
    }
    as_subject(subject + ", " + name, [&] { found->second(read_field(given, name.c_str())); });
  }
}

Read read_into(std::string& text) {
  return [&](const mxArray* given) { text = read_text(given); };
}

Read read_into(bool& flag) {
  return [&](const mxArray* given) { flag = read_number<bool>(given); };
}

Read read_into(std::chrono::milliseconds& time) {
  return [&](const mxArray* given) { time = to_milliseconds(read_number<double>(given)); };
}

Read read_into(Offer& offer) {
  return [&](const mxArray* given) {
    read_fields(given, "what the node offers",
                {{"MessageV4", read_into(offer.message_v4)},
                 {"StringTable", read_into(offer.string_table)},
                 {"CombinedConnect", read_into(offer.combined_connect)}});
  };
}

}  // namespace

NodeOptions read_node_options(const mxArray* given) {
  NodeOptions options;
  std::chrono::milliseconds heartbeat = options.heartbeat_period;
  read_fields(given, "node options",
              {{"NodeName", read_into(options.name)},
               {"NodeID",
                [&](const mxArray* text) {
                  const auto id = NodeId::parse(read_text(text));
                  if (!id) throw Misfit("expected the id of a node, got another text");
                  options.id = *id;
                }},
               {"ClientOffer", read_into(options.client_offer)},
               {"ServerOffer", read_into(options.server_offer)},
               {"RequestTimeout", read_into(options.request_timeout)},
               {"ConnectTimeout", read_into(options.connect_timeout)},
               {"HeartbeatPeriod",
                [&](const mxArray* seconds) {
                  read_into(heartbeat)(seconds);
                  options.heartbeat_period = heartbeat;
                  options.local.heartbeat_period = heartbeat;
                }},
               {"MemoryTransferLimit",
                [&](const mxArray* bytes) {
                  options.memory_transfer_limit = read_number<std::uint32_t>(bytes);
                }},
               {"ClientSessionLimit",
                [&](const mxArray* bytes) {
                  options.budget.client_session = read_number<std::uint32_t>(bytes);
                }},
               {"CertificateFile", read_into(options.tls.certificate_file)},
               {"KeyFile", read_into(options.tls.key_file)},
               {"AuthorityFiles",
                [&](const mxArray* files) { options.tls.authority_files = read_texts(files); }},
               {"RequireTls", read_into(options.tls.is_required)}});
  return options;
}

}  // namespace rr::matlab
