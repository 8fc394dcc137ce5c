// SPDX-License-Identifier: Apache-2.0
#include "runtime/cpp/src/value/conformance_types.hpp"

#include <cstddef>

// offsetof is asked for structs that hold maps, which have no standard layout.
#pragma GCC diagnostic ignored "-Winvalid-offsetof"

namespace conformance::types {
namespace {

constexpr ::rr::Field sample_fields[] = {
    ::rr::field<std::uint32_t>("seq", offsetof(Sample, seq)),
    ::rr::field<double>("stamp", offsetof(Sample, stamp)),
    ::rr::field<std::array<float, 3>>("accel", offsetof(Sample, accel)),
};
constexpr ::rr::Field reading_fields[] = {
    ::rr::field<std::int8_t>("kind", offsetof(Reading, kind)),
    ::rr::field<std::uint8_t>("valid", offsetof(Reading, valid)),
    ::rr::field<::rr::BoundedArray<std::uint16_t, 8>>("payload", offsetof(Reading, payload)),
    ::rr::field<::rr::FixedMultiArray<double, 2, 2>>("gain", offsetof(Reading, gain)),
    ::rr::field<Sample>("head", offsetof(Reading, head)),
    ::rr::field<std::array<Sample, 2>>("pair", offsetof(Reading, pair)),
    ::rr::field<::rr::BoundedArray<Sample, 3>>("tail", offsetof(Reading, tail)),
    ::rr::field<Vector3>("origin", offsetof(Reading, origin)),
    ::rr::field<std::array<Vector3, 2>>("base", offsetof(Reading, base)),
    ::rr::field<::rr::BoundedArray<Vector3, 2>>("path", offsetof(Reading, path)),
    ::rr::field<::rr::FixedMultiArray<Pixel, 2, 2>>("block", offsetof(Reading, block)),
};
constexpr ::rr::Field counter_fields[] = {
    ::rr::field<std::int64_t>("up", offsetof(Counter, up)),
    ::rr::field<std::uint64_t>("down", offsetof(Counter, down)),
    ::rr::field<std::array<std::int16_t, 3>>("trim", offsetof(Counter, trim)),
    ::rr::field<::rr::FixedMultiArray<std::uint32_t, 2, 2>>("mask", offsetof(Counter, mask)),
};
constexpr ::rr::Field stats_fields[] = {
    ::rr::field<std::int32_t>("count", offsetof(Stats, count)),
    ::rr::field<double>("mean", offsetof(Stats, mean)),
    ::rr::field<std::string>("label", offsetof(Stats, label)),
};
constexpr ::rr::Field leaf_fields[] = {
    ::rr::field<std::string>("name", offsetof(Leaf, name)),
    ::rr::field<Mode>("mode", offsetof(Leaf, mode)),
    ::rr::field<std::optional<Stats>>("stats", offsetof(Leaf, stats)),
};
constexpr ::rr::Field tree_fields[] = {
    ::rr::field<std::string>("name", offsetof(Tree, name)),
    ::rr::field<std::optional<Leaf>>("main", offsetof(Tree, main)),
    ::rr::field<std::optional<std::vector<std::optional<Leaf>>>>("leaves", offsetof(Tree, leaves)),
    ::rr::field<std::optional<std::map<std::string, std::optional<Leaf>>>>("by_name",
                                                                           offsetof(Tree, by_name)),
    ::rr::field<::rr::Recursive<Tree>>("child", offsetof(Tree, child)),
    ::rr::field<::rr::VarValue>("extra", offsetof(Tree, extra)),
};
constexpr ::rr::Field everything_fields[] = {
    ::rr::field<double>("v_double", offsetof(Everything, v_double)),
    ::rr::field<float>("v_single", offsetof(Everything, v_single)),
    ::rr::field<std::int8_t>("v_int8", offsetof(Everything, v_int8)),
    ::rr::field<std::uint8_t>("v_uint8", offsetof(Everything, v_uint8)),
    ::rr::field<std::int16_t>("v_int16", offsetof(Everything, v_int16)),
    ::rr::field<std::uint16_t>("v_uint16", offsetof(Everything, v_uint16)),
    ::rr::field<std::int32_t>("v_int32", offsetof(Everything, v_int32)),
    ::rr::field<std::uint32_t>("v_uint32", offsetof(Everything, v_uint32)),
    ::rr::field<std::int64_t>("v_int64", offsetof(Everything, v_int64)),
    ::rr::field<std::uint64_t>("v_uint64", offsetof(Everything, v_uint64)),
    ::rr::field<bool>("v_bool", offsetof(Everything, v_bool)),
    ::rr::field<std::complex<double>>("v_cdouble", offsetof(Everything, v_cdouble)),
    ::rr::field<std::complex<float>>("v_csingle", offsetof(Everything, v_csingle)),
    ::rr::field<std::string>("v_string", offsetof(Everything, v_string)),
    ::rr::field<Mode>("v_mode", offsetof(Everything, v_mode)),
    ::rr::field<::rr::Array<double>>("a_double", offsetof(Everything, a_double)),
    ::rr::field<std::array<std::int16_t, 4>>("a_fixed", offsetof(Everything, a_fixed)),
    ::rr::field<::rr::BoundedArray<std::uint8_t, 6>>("a_max", offsetof(Everything, a_max)),
    ::rr::field<::rr::MultiArray<float>>("m_single", offsetof(Everything, m_single)),
    ::rr::field<::rr::FixedMultiArray<std::int32_t, 2, 3>>("m_fixed",
                                                           offsetof(Everything, m_fixed)),
    ::rr::field<std::optional<std::vector<double>>>("l_double", offsetof(Everything, l_double)),
    ::rr::field<std::optional<std::map<std::int32_t, std::string>>>("i_string",
                                                                    offsetof(Everything, i_string)),
    ::rr::field<std::optional<std::map<std::string, ::rr::Array<std::int32_t>>>>(
        "s_array", offsetof(Everything, s_array)),
    ::rr::field<std::optional<std::vector<Mode>>>("l_mode", offsetof(Everything, l_mode)),
    ::rr::field<std::optional<Stats>>("s_stats", offsetof(Everything, s_stats)),
    ::rr::field<std::optional<std::vector<std::optional<Stats>>>>("l_stats",
                                                                  offsetof(Everything, l_stats)),
    ::rr::field<Sample>("p_sample", offsetof(Everything, p_sample)),
    ::rr::field<::rr::Array<Sample>>("p_samples", offsetof(Everything, p_samples)),
    ::rr::field<::rr::MultiArray<Sample>>("p_grid", offsetof(Everything, p_grid)),
    ::rr::field<std::optional<std::map<std::int32_t, Sample>>>("p_map",
                                                               offsetof(Everything, p_map)),
    ::rr::field<Vector3>("n_point", offsetof(Everything, n_point)),
    ::rr::field<::rr::Array<Vector3>>("n_points", offsetof(Everything, n_points)),
    ::rr::field<::rr::MultiArray<Vector3>>("n_grid", offsetof(Everything, n_grid)),
    ::rr::field<std::optional<std::vector<Transform>>>("n_list", offsetof(Everything, n_list)),
    ::rr::field<::rr::VarValue>("any", offsetof(Everything, any)),
    ::rr::field<std::optional<::rr::VarList>>("l_any", offsetof(Everything, l_any)),
    ::rr::field<std::optional<::rr::VarStringMap>>("s_any", offsetof(Everything, s_any)),
};

constexpr const ::rr::RecordType* records[] = {
    &rr_Vector3, &rr_Transform, &rr_Twist, &rr_Pixel, &rr_Ticks, &rr_Knots,     &rr_Sample,
    &rr_Reading, &rr_Counter,   &rr_Stats, &rr_Leaf,  &rr_Tree,  &rr_Everything};

}  // namespace

constinit const ::rr::RecordType rr_Vector3{"conformance.types.Vector3", ::rr::ElementType::double_,
                                            3, ::rr::record_operations<Vector3>};
constinit const ::rr::RecordType rr_Transform{"conformance.types.Transform",
                                              ::rr::ElementType::double_, 7,
                                              ::rr::record_operations<Transform>};
constinit const ::rr::RecordType rr_Twist{"conformance.types.Twist", ::rr::ElementType::single, 6,
                                          ::rr::record_operations<Twist>};
constinit const ::rr::RecordType rr_Pixel{"conformance.types.Pixel", ::rr::ElementType::uint8, 3,
                                          ::rr::record_operations<Pixel>};
constinit const ::rr::RecordType rr_Ticks{"conformance.types.Ticks", ::rr::ElementType::int64, 2,
                                          ::rr::record_operations<Ticks>};
constinit const ::rr::RecordType rr_Knots{"conformance.types.Knots", ::rr::ElementType::double_, 9,
                                          ::rr::record_operations<Knots>};
constinit const ::rr::RecordType rr_Sample{::rr::RecordKind::pod, "conformance.types.Sample",
                                           sample_fields, ::rr::record_operations<Sample>};
constinit const ::rr::RecordType rr_Reading{::rr::RecordKind::pod, "conformance.types.Reading",
                                            reading_fields, ::rr::record_operations<Reading>};
constinit const ::rr::RecordType rr_Counter{::rr::RecordKind::pod, "conformance.types.Counter",
                                            counter_fields, ::rr::record_operations<Counter>};
constinit const ::rr::RecordType rr_Stats{::rr::RecordKind::struct_, "conformance.types.Stats",
                                          stats_fields, ::rr::record_operations<Stats>};
constinit const ::rr::RecordType rr_Leaf{::rr::RecordKind::struct_, "conformance.types.Leaf",
                                         leaf_fields, ::rr::record_operations<Leaf>};
constinit const ::rr::RecordType rr_Tree{::rr::RecordKind::struct_, "conformance.types.Tree",
                                         tree_fields, ::rr::record_operations<Tree>};
constinit const ::rr::RecordType rr_Everything{::rr::RecordKind::struct_,
                                               "conformance.types.Everything", everything_fields,
                                               ::rr::record_operations<Everything>};

constinit const ::rr::Definition rr_definition{.name = "conformance.types",
                                               .text = {},
                                               .version = {0, 10, 0, 0},
                                               .imports = {},
                                               .records = records,
                                               .exceptions = {},
                                               .objects = {}};

}  // namespace conformance::types
