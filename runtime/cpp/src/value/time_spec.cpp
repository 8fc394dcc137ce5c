// SPDX-License-Identifier: Apache-2.0
#include "rr/time_spec.hpp"

namespace rr {
namespace {

constexpr Field time_spec_fields[] = {
    field<std::int64_t>("seconds", offsetof(TimeSpec, seconds)),
    field<std::int32_t>("nanoseconds", offsetof(TimeSpec, nanoseconds)),
};

}  // namespace

constinit const RecordType time_spec_type{RecordKind::struct_, "RobotRaconteur.TimeSpec",
                                          time_spec_fields, record_operations<TimeSpec>};

}  // namespace rr
