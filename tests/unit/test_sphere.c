/* Spheres in memory: growth keeps what is there, derived values, dummies out of everything's
 * way. */
#include "model/sphere.h"

#include "check.h"
#include "model/material.h"

TEST(growth_keeps_contents)
{
    struct spheres spheres;
    spheres_init(&spheres);
    for (int i = 0; i < 1000; i++) {
        spheres_reserve(&spheres, i + 1);
        spheres.n_owned = spheres.n_all = i + 1;
        spheres.id[i] = 3 * i;
        sphere_position(&spheres, i)[1] = 0.5 * i;
        spheres.dissipated_damping[i] = i;
        spheres_pad(&spheres);
    }
    bool kept = true;
    for (int i = 0; i < 1000; i++)
        kept = kept && spheres.id[i] == 3 * i && sphere_position(&spheres, i)[1] == 0.5 * i &&
               spheres.dissipated_damping[i] == i;
    EXPECT(kept);
    EXPECT((uintptr_t)spheres.motion % 64 == 0 && (uintptr_t)spheres.force % 64 == 0);
    spheres_clear(&spheres);
    EXPECT(spheres.motion == NULL && spheres.n_all == 0);
}

TEST(fields_lie_where_the_table_says)
{
    struct spheres spheres;
    spheres_init(&spheres);
    spheres_reserve(&spheres, 3);
    spheres.n_owned = spheres.n_all = 3;
    for (int f = 0; f < SPHERE_N_FIELDS; f++) {
        const struct field_view view = sphere_view(&spheres, f);
        memset(field_at(&view, 2), f + 1, field_size(&sphere_fields[f]));
    }
    /* No field overwrote another. */
    for (int f = 0; f < SPHERE_N_FIELDS; f++) {
        const struct field_view view = sphere_view(&spheres, f);
        const unsigned char *bytes = field_at(&view, 2);
        for (size_t k = 0; k < field_size(&sphere_fields[f]); k++)
            EXPECT(bytes[k] == f + 1);
    }
    sphere_velocity(&spheres, 1)[2] = 4.0;
    const struct field_view velocity = sphere_view(&spheres, SPHERE_VELOCITY);
    EXPECT(((double *)field_at(&velocity, 1))[2] == 4.0);
    spheres_clear(&spheres);
}

TEST(derived_values)
{
    double density[2] = {1000.0, 2000.0};
    const struct materials materials = {.n = 2, .density = density};
    struct spheres spheres;
    spheres_init(&spheres);
    spheres_reserve(&spheres, 1);
    spheres.n_owned = spheres.n_all = 1;
    spheres.material[0] = 1;
    spheres.motion[0].lane[3] = 0.5;
    sphere_angular_velocity(&spheres, 0)[0] = 3.0;
    sphere_complete(&spheres, 0, &materials);
    EXPECT(spheres.motion[0].lane[7] == 0.5);
    EXPECT(spheres.spin[0].lane[0] == 1.5 && spheres.spin[0].lane[3] == 2.0);
    EXPECT_NEAR(1.0 / sphere_inverse_mass(&spheres, 0), 1047.1975511965977, 1e-9);
    spheres_clear(&spheres);
}

TEST(dummies_touch_nothing)
{
    struct spheres spheres;
    spheres_init(&spheres);
    const double *a = sphere_position(&spheres, 0), *b = sphere_position(&spheres, 1);
    EXPECT(b[0] - a[0] > 1e8 && a[0] > 1e8);
    EXPECT(sphere_radius(&spheres, 0) > 0.0 && sphere_inverse_mass(&spheres, 1) > 0.0);
    spheres_clear(&spheres);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
