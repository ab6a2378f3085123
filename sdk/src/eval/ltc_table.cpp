// The table of `etendue fit-ltc --rows`.
#include "etendue/ltc.h"

namespace etendue::eval {

const LtcTable& ltc_table() {
  static const LtcTable table(33, {
#include "ltc_table.inc"
                                  });
  return table;
}

}  // namespace etendue::eval
