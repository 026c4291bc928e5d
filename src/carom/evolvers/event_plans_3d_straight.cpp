#include "carom/evolvers/event_plans.h"

namespace carom {

template class EventPlans<3, false>;

}  // namespace carom
