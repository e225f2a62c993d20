// SPDX-License-Identifier: Apache-2.0
#include "format/logistic.h"

namespace sac {

constexpr LogisticTables kLogisticTables;

}  // namespace sac
