#include "carom/evolvers/toi_written_make.h"

namespace carom {

template std::unique_ptr<Simulation> make_toi_written<3>(const Scenario&, Parts<3>,
                                                         const std::shared_ptr<LawFormula>&);

}  // namespace carom
