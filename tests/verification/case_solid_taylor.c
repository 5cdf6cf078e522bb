/* Taylor's copper cylinder, a coarse one: see taylor.h. */
#include "taylor.h"
#include "verify.h"

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Solids: Taylor bar",
                 "commonly quoted; E 117e9, nu .35, rho 8930, sy 400e6, H 100e6");
    const struct taylor_result result = taylor_run(3, 36);
    taylor_rows(&result, 3, 36);
    return verify_end();
}
