// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "files/alembic/alembic_archive.h"
#include "sac/status.h"

namespace sac {

// The samples of a property. Messages begin with its name.
class AlembicSamples {
 public:
  // Finds where the samples are: all but those of a compound. kCorrupt if there are fewer than the header announces.
  // `archive` must outlive this.
  static Status Open(AlembicArchive& archive, const AlembicProperty& property, AlembicSamples& samples);

  // None, as long as nothing was opened.
  std::uint32_t size() const { return samples_; }
  bool constant() const { return stored_.size() <= 1; }

  const AlembicTimeSampling& times() const { return *times_; }
  // Where `time`, in seconds, lies among the samples; there is one at least.
  AlembicMoment At(double time) const { return times_->At(time, samples_); }

  // The number of stored samples, and whether two samples are stored as the same bytes.
  std::uint32_t stored() const { return static_cast<std::uint32_t>(stored_.size()); }
  bool Same(std::uint32_t a, std::uint32_t b) const { return stored_[Stored(a)] == stored_[Stored(b)]; }
  std::uint32_t Stored(std::uint32_t sample) const;

  // The number of numbers in a sample.
  Status Count(std::uint32_t sample, std::uint64_t& count) const { return StoredCount(Stored(sample), count); }
  Status StoredCount(std::uint32_t stored, std::uint64_t& count) const;

  // Reads the numbers of a sample, of whatever type they are in the file. Number is float, double or std::int64_t, as
  // which floats are kCorrupt.
  template <typename Number>
  Status Read(std::uint32_t sample, std::vector<Number>& numbers) const {
    return ReadStored(Stored(sample), numbers);
  }
  template <typename Number>
  Status ReadStored(std::uint32_t stored, std::vector<Number>& numbers) const;

  // Reads a sample that is a text.
  Status ReadText(std::uint32_t sample, std::string& text) const;

 private:
  Status Bytes(std::uint32_t stored, std::string& bytes) const;
  Status Named(const Status& status) const;

  const OgawaReader* ogawa_ = nullptr;
  const AlembicTimeSampling* times_ = nullptr;
  AlembicProperty header_;  // without its properties
  std::uint32_t samples_ = 0;
  std::vector<OgawaRef> stored_;
};

// The value of an IEEE 754 half.
float HalfToFloat(std::uint16_t half);

}  // namespace sac
