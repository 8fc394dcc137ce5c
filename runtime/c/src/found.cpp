// SPDX-License-Identifier: Apache-2.0
#include "runtime/c/src/found.hpp"

#include <memory>
#include <utility>

#include "rr/varvalue.hpp"

namespace rr::capi {
namespace {

Data write_attributes(const VarStringMap& attributes) {
  return write_data(type_of<VarStringMap>, &attributes, "attributes");
}

template <class Result, class Item>
Result* make_result(std::vector<Item> items) {
  auto result = std::make_unique<Result>();
  for (Item& item : items) result->views.emplace_back(std::move(item));
  return result.release();
}

template <class Result, class Info>
void read(const Result* result, std::size_t place, Info* info, const char* none) {
  const auto& views = need(result, none).views;
  static_cast<void>(known(info, true));
  if (place >= views.size()) throw Error(ErrorCode::out_of_range, "there are not so many results");
  fill(info, views[place].info());
}

}  // namespace

DetectedNodeView::DetectedNodeView(DetectedNode node)
    : node_(std::move(node)), urls_(view_all(node_.urls)) {
  info_ = {sizeof info_, id_of(node_.id), view(node_.name), urls_.data(), urls_.size()};
}

FoundServiceView::FoundServiceView(FoundService service)
    : service_(std::move(service)),
      urls_(view_all(service_.urls)),
      implements_(view_all(service_.implements)),
      attributes_(write_attributes(service_.attributes)) {
  info_ = {.size = sizeof info_,
           .name = view(service_.name),
           .node = id_of(service_.node),
           .node_name = view(service_.node_name),
           .urls = urls_.data(),
           .url_count = urls_.size(),
           .object_type = view(service_.object_type),
           .implements = implements_.data(),
           .implement_count = implements_.size(),
           .attributes = attributes_.elements()};
}

rr_detected_nodes* hand_out(std::vector<DetectedNode> nodes) {
  return make_result<rr_detected_nodes>(std::move(nodes));
}
rr_found_services* hand_out(std::vector<FoundService> services) {
  return make_result<rr_found_services>(std::move(services));
}

}  // namespace rr::capi

using rr::capi::guarded;

extern "C" {

size_t rr_detected_nodes_count(const rr_detected_nodes* nodes) {
  return nodes != nullptr ? nodes->views.size() : 0;
}

rr_status rr_detected_nodes_read(const rr_detected_nodes* nodes, size_t place,
                                 rr_detected_node* info, rr_error** error) {
  return guarded(error, [&] { rr::capi::read(nodes, place, info, "there are no nodes"); });
}

void rr_detected_nodes_release(rr_detected_nodes* nodes) { rr::capi::release(nodes); }

size_t rr_found_services_count(const rr_found_services* services) {
  return services != nullptr ? services->views.size() : 0;
}

rr_status rr_found_services_read(const rr_found_services* services, size_t place,
                                 rr_found_service* info, rr_error** error) {
  return guarded(error, [&] { rr::capi::read(services, place, info, "there are no services"); });
}

void rr_found_services_release(rr_found_services* services) { rr::capi::release(services); }

}  // extern "C"
