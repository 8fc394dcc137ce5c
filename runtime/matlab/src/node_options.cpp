// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/node_options.hpp"

#include <map>
#include <string>

#include "rr/error.hpp"
#include "runtime/matlab/src/call.hpp"
#include "runtime/matlab/src/credentials.hpp"
#include "runtime/matlab/src/struct_fields.hpp"

namespace rr::matlab {
namespace {

ReadField read_offer(Offer& offer) {
  return [&](const mxArray* given) {
    read_fields(given, "what the node offers",
                {{"MessageV4", read_into(offer.message_v4)},
                 {"StringTable", read_into(offer.string_table)},
                 {"CombinedConnect", read_into(offer.combined_connect)}});
  };
}

NodeId read_node_id(const std::string& text) {
  const auto id = NodeId::parse(text);
  if (!id) throw Misfit("expected the id of a node, got another text");
  return *id;
}

}  // namespace

RuntimeOptions read_node_options(const mxArray* given) {
  RuntimeOptions options;
  NodeOptions& node = options.node;
  TlsOptions& tls = node.tls;
  std::chrono::milliseconds heartbeat = node.heartbeat_period;
  std::string audit_file;
  read_fields(
      given, "node options",
      {{"NodeName", read_into(node.name)},
       {"NodeID", [&](const mxArray* text) { node.id = read_node_id(read_text(text)); }},
       {"ClientOffer", read_offer(node.client_offer)},
       {"ServerOffer", read_offer(node.server_offer)},
       {"RequestTimeout", read_into(node.request_timeout)},
       {"ConnectTimeout", read_into(node.connect_timeout)},
       {"HeartbeatPeriod",
        [&](const mxArray* seconds) {
          read_into(heartbeat)(seconds);
          node.heartbeat_period = heartbeat;
          node.local.heartbeat_period = heartbeat;
        }},
       {"MemoryTransferLimit",
        [&](const mxArray* bytes) {
          node.memory_transfer_limit = read_number<std::uint32_t>(bytes);
        }},
       {"ClientSessionLimit",
        [&](const mxArray* bytes) {
          node.budget.client_session = read_number<std::uint32_t>(bytes);
        }},
       {"CertificateFile", read_into(tls.certificate_file)},
       {"KeyFile", read_into(tls.key_file)},
       {"AuthorityFiles", read_into(tls.authority_files)},
       {"RevocationFiles", read_into(tls.revocation_files)},
       {"Pins",
        [&](const mxArray* pins) {
          for (const auto& [id, value] : read_varvalues(pins, "Pins", "a containers.Map")) {
            const auto* const sha256 = value.get_if<std::string>();
            if (sha256 == nullptr) throw Misfit("expected a text for each node");
            tls.pins.emplace(read_node_id(id), *sha256);
          }
        }},
       {"RequireTls", read_into(tls.is_required)},
       {"MustCertifyClients", read_into(tls.must_certify_clients)},
       {"TrustSystemAuthorities",
        [&](const mxArray* flag) { tls.trust_system_authorities = read_number<bool>(flag); }},
       {"AcceptsOutdatedLists", read_into(tls.accepts_outdated_lists)},
       {"LookAgainPeriod", read_into(tls.look_again_period)},
       {"AuditFile", read_into(audit_file)},
       {"AuditRequests", read_into(node.audit.requests)},
       {"SharedMemory", read_into(node.local.shared_memory)},
       {"Spin", read_into(node.spin)},
       {"AllowClearCredentials", read_into(options.allow_clear_credentials)}});
  if (!audit_file.empty()) node.audit.on_event = AuditLog(audit_file);
  return options;
}

}  // namespace rr::matlab
