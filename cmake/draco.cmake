# SPDX-License-Identifier: Apache-2.0
# draco::draco from the source in SAC_DRACO_SOURCE (`scripts/draco-source` prints such a folder), for platforms for which
# there is no package of it. These files are those that the libraries link, found by a linker's map.
set(draco_files
  attributes/attribute_octahedron_transform.cc
  attributes/attribute_quantization_transform.cc
  attributes/attribute_transform.cc
  attributes/geometry_attribute.cc
  attributes/point_attribute.cc
  compression/attributes/attributes_decoder.cc
  compression/attributes/attributes_encoder.cc
  compression/attributes/prediction_schemes/prediction_scheme_encoder_factory.cc
  compression/attributes/sequential_attribute_decoder.cc
  compression/attributes/sequential_attribute_decoders_controller.cc
  compression/attributes/sequential_attribute_encoder.cc
  compression/attributes/sequential_attribute_encoders_controller.cc
  compression/attributes/sequential_integer_attribute_decoder.cc
  compression/attributes/sequential_integer_attribute_encoder.cc
  compression/attributes/sequential_normal_attribute_decoder.cc
  compression/attributes/sequential_normal_attribute_encoder.cc
  compression/attributes/sequential_quantization_attribute_decoder.cc
  compression/attributes/sequential_quantization_attribute_encoder.cc
  compression/bit_coders/direct_bit_encoder.cc
  compression/bit_coders/rans_bit_decoder.cc
  compression/bit_coders/rans_bit_encoder.cc
  compression/entropy/shannon_entropy.cc
  compression/entropy/symbol_decoding.cc
  compression/entropy/symbol_encoding.cc
  compression/expert_encode.cc
  compression/mesh/mesh_decoder.cc
  compression/mesh/mesh_edgebreaker_decoder.cc
  compression/mesh/mesh_edgebreaker_decoder_impl.cc
  compression/mesh/mesh_edgebreaker_encoder.cc
  compression/mesh/mesh_edgebreaker_encoder_impl.cc
  compression/mesh/mesh_encoder.cc
  compression/mesh/mesh_sequential_encoder.cc
  compression/point_cloud/point_cloud_decoder.cc
  compression/point_cloud/point_cloud_encoder.cc
  compression/point_cloud/point_cloud_sequential_encoder.cc
  core/bit_utils.cc
  core/bounding_box.cc
  core/data_buffer.cc
  core/decoder_buffer.cc
  core/divide.cc
  core/draco_types.cc
  core/encoder_buffer.cc
  core/options.cc
  core/quantization_utils.cc
  mesh/corner_table.cc
  mesh/mesh.cc
  mesh/mesh_attribute_corner_table.cc
  mesh/mesh_misc_functions.cc
  metadata/geometry_metadata.cc
  metadata/metadata.cc
  metadata/metadata_decoder.cc
  metadata/metadata_encoder.cc
  point_cloud/point_cloud.cc)
list(TRANSFORM draco_files PREPEND ${SAC_DRACO_SOURCE}/src/draco/)

# The layout of Draco's classes depends on these: all that includes Draco has to see the same.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/draco/draco/draco_features.h CONTENT [[
#pragma once
#define DRACO_MESH_COMPRESSION_SUPPORTED
#define DRACO_NORMAL_ENCODING_SUPPORTED
#define DRACO_STANDARD_EDGEBREAKER_SUPPORTED
#define DRACO_PREDICTIVE_EDGEBREAKER_SUPPORTED
]])

add_library(sac_draco STATIC ${draco_files})
target_include_directories(sac_draco SYSTEM PUBLIC ${PROJECT_BINARY_DIR}/draco ${SAC_DRACO_SOURCE}/src)
target_compile_features(sac_draco PRIVATE cxx_std_17)
set_target_properties(sac_draco PROPERTIES CXX_STANDARD 17)
target_compile_options(sac_draco PRIVATE -w -ffp-contract=off)
# The same name as that of an installed Draco, also in what this project installs.
add_library(draco::draco INTERFACE IMPORTED GLOBAL)
target_link_libraries(draco::draco INTERFACE sac_draco)
