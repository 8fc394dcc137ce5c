// SPDX-License-Identifier: Apache-2.0
#include "conformance/runners/matlab/json_values.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "rr/matlab/containers.hpp"

namespace rr::conformance {
namespace {

Json json_of_number(double number) {
  constexpr double exact = 9007199254740992;  // 2^53
  const bool is_integer = std::fabs(number) < exact && number == std::trunc(number) &&
                          !(number == 0 && std::signbit(number));
  if (is_integer) return static_cast<std::int64_t>(number);
  return number;
}

}  // namespace

mxArray* json_to_mex(const Json& json) {
  if (json.is_object()) {
    mxArray* const record = mxCreateStructMatrix(1, 1, 0, nullptr);
    for (const auto& [name, value] : json.items()) {
      mxSetFieldByNumber(record, 0, mxAddField(record, name.c_str()), json_to_mex(value));
    }
    return record;
  }
  if (json.is_array()) {
    std::vector<mxArray*> items;
    for (const Json& item : json) items.push_back(json_to_mex(item));
    return matlab::make_cells(items);
  }
  if (json.is_string()) return matlab::make_text(json.get_ref<const std::string&>());
  if (json.is_boolean()) return mxCreateLogicalScalar(json.get<bool>());
  if (json.is_number()) return mxCreateDoubleScalar(json.get<double>());
  return matlab::make_null();
}

Json json_from_mex(const mxArray* value) {
  if (mxIsStruct(value) && matlab::count_of(value) == 1) {
    Json object = Json::object();
    for (int i = 0; i < mxGetNumberOfFields(value); ++i) {
      const char* const name = mxGetFieldNameByNumber(value, i);
      object[name] = json_from_mex(matlab::read_field(value, name));
    }
    return object;
  }
  if (mxIsCell(value)) {
    Json list = Json::array();
    for (std::size_t i = 0; i < matlab::count_of(value); ++i) {
      list.push_back(json_from_mex(mxGetCell(value, static_cast<mwIndex>(i))));
    }
    return list;
  }
  if (mxIsChar(value)) return matlab::read_text(value);
  if (mxIsLogicalScalar(value)) return mxIsLogicalScalarTrue(value);
  if (mxIsNumeric(value) && matlab::count_of(value) == 0) return nullptr;
  if (mxIsNumeric(value) && matlab::count_of(value) == 1) {
    return json_of_number(matlab::read_number<double>(value));
  }
  throw matlab::Misfit("no JSON: " + matlab::described(value));
}

}  // namespace rr::conformance
