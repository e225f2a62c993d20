// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "files/scene_reader.h"
#include "sac/clip.h"
#include "sac/status.h"

namespace sac {

// True for .abc in any case.
bool IsAlembicName(const std::string& path);

// Opens an Alembic file (Ogawa) as a clip of one mesh. With a rate, its frames are taken at that. kUnsupported, with
// the way to convert it: Alembic in HDF5.
Status OpenAlembicClip(const std::string& path, const FrameRate& wanted, std::unique_ptr<SceneReader>& reader);

}  // namespace sac
