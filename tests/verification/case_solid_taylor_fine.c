/* Taylor's copper cylinder, in finer cells: see taylor.h. */
/* long */
#include "taylor.h"
#include "verify.h"

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Solids: Taylor bar, finer",
                 "commonly quoted; E 117e9, nu .35, rho 8930, sy 400e6, H 100e6");
    taylor_rows(6, 72);
    return verify_end();
}
