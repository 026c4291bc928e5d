#include "carom/evolvers/event_make.h"

namespace carom {

template std::unique_ptr<Simulation> make_event<3>(const Scenario& scene);

}  // namespace carom
