#include "format/logistic.h"

namespace sac {

constexpr LogisticTables kLogisticTables;

}  // namespace sac
