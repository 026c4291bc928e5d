#include "carom/evolvers/event_plans.h"

namespace carom {

template class EventPlans<2, false>;

}  // namespace carom
