// SPDX-License-Identifier: Apache-2.0
#include "runtime/matlab/src/struct_fields.hpp"

#include <cmath>

#include "rr/error.hpp"
#include "runtime/matlab/src/call.hpp"
#include "runtime/matlab/src/credentials.hpp"

namespace rr::matlab {

void read_fields(const mxArray* given, const std::string& subject,
                 const std::map<std::string, ReadField>& known) {
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

ReadField read_into(std::string& text) {
  return [&](const mxArray* given) { text = read_text(given); };
}

ReadField read_into(bool& flag) {
  return [&](const mxArray* given) { flag = read_number<bool>(given); };
}

ReadField read_into(std::chrono::milliseconds& time) {
  return [&](const mxArray* given) { time = to_milliseconds(read_number<double>(given)); };
}

ReadField read_into(std::chrono::microseconds& time) {
  return [&](const mxArray* given) {
    const auto seconds = read_number<double>(given);
    if (!(seconds >= 0 && seconds <= 1)) throw Misfit("expected seconds from 0 to 1");
    time = std::chrono::microseconds(std::lround(seconds * 1e6));
  };
}

ReadField read_into(std::vector<std::string>& texts) {
  return [&](const mxArray* given) { texts = read_texts(given); };
}

}  // namespace rr::matlab
