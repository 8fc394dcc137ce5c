// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>

#include "rr/client.hpp"
#include "rr/node.hpp"
#include "runtime/c/src/border.hpp"
#include "runtime/c/src/completion.hpp"
#include "runtime/c/src/tables.hpp"

/// Handles of nodes, clients and objects.
struct rr_node {
  std::shared_ptr<rr::capi::Keeper> keeper;
  std::shared_ptr<rr::Node> node;
};
struct rr_client {
  rr::ClientBase client;
  std::shared_ptr<rr::capi::ClientTables> tables;
  std::shared_ptr<rr::capi::RawStub> root;
};
struct rr_object {
  std::shared_ptr<rr::capi::RawStub> stub;
};

namespace rr::capi {

rr_object* make_object(std::shared_ptr<Stub> stub);
inline RawStub& stub_of(const rr_object* object) {
  return *need(object, "there is no object").stub;
}
inline std::uint8_t access_of(std::uint32_t access) { return static_cast<std::uint8_t>(access); }
/// A map of strings to varvalues. Throws rr::Error.
std::map<std::string, VarValue> read_map(const rr_elements& elements);

}  // namespace rr::capi
