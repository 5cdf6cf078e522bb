/* The topology of surfaces: what is joined, split, left out; edges, neighbours, normals. */
#include "check.h"
#include "model/mesh.h"

static const struct vec3 CUBE[8] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0},
                                    {0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}};
static const int CUBE_FACETS[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};

/* Every edge knows its faces, every face its edges, every vertex its edges. */
static bool is_consistent(const struct mesh *mesh)
{
    for (int f = 0; f < mesh->n_faces; f++) {
        const struct mesh_face *face = &mesh->faces[f];
        for (int k = 0; k < face->n; k++) {
            const int a = face->vertices[k], b = face->vertices[(k + 1) % face->n];
            const struct mesh_edge *edge = &mesh->edges[face->edges[k]];
            const bool joins = (edge->vertices[0] == a && edge->vertices[1] == b) ||
                               (edge->vertices[0] == b && edge->vertices[1] == a);
            if (!joins || edge->faces[0] < 0)
                return false;
        }
    }
    int n = 0;
    for (int v = 0; v < mesh->n_vertices; v++)
        for (int k = mesh->edge_begin[v]; k < mesh->edge_begin[v + 1]; k++, n++) {
            const int *ends = mesh->edges[mesh->edge_list[k]].vertices;
            if (ends[0] != v && ends[1] != v)
                return false;
        }
    return n == 2 * mesh->n_edges;
}

static int count_free_edges(const struct mesh *mesh)
{
    int n = 0;
    for (int e = 0; e < mesh->n_edges; e++)
        n += mesh->edges[e].faces[1] < 0;
    return n;
}

TEST(a_cube_has_eight_vertices_twelve_edges_six_faces)
{
    struct mesh mesh;
    mesh_build(&mesh, 8, CUBE, 6, CUBE_FACETS);
    EXPECT(mesh.n_vertices == 8 && mesh.n_edges == 12 && mesh.n_faces == 6);
    EXPECT(mesh_n_features(&mesh) == 26);
    EXPECT(count_free_edges(&mesh) == 0);
    EXPECT(is_consistent(&mesh));
    for (int f = 0; f < 6; f++) {
        const struct vec3 outward =
            vec3_sub(mesh.place[mesh.faces[f].vertices[0]], (struct vec3){0.5, 0.5, 0.5});
        EXPECT_NEAR(vec3_dot(mesh.face_normal[f], outward), 0.5, 1e-15);
        EXPECT_NEAR(vec3_norm(mesh.face_normal[f]), 1.0, 1e-15);
    }
    mesh_clear(&mesh);
}

TEST(equal_vertices_are_joined)
{
    /* Two quads that share a side, each with vertices of its own; one zero has a sign. */
    const struct vec3 vertices[8] = {{0, 0, 0}, {1, 0, 0},    {1, 1, 0}, {0, 1, 0},
                                     {1, 0, 0}, {2, 0, -0.0}, {2, 1, 0}, {1, 1, -0.0}};
    const int facets[2][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}};
    struct mesh mesh;
    mesh_build(&mesh, 8, vertices, 2, facets);
    EXPECT(mesh.n_vertices == 6 && mesh.n_edges == 7 && mesh.n_faces == 2);
    EXPECT(count_free_edges(&mesh) == 6);
    EXPECT(is_consistent(&mesh));
    mesh_clear(&mesh);
}

TEST(a_warped_quad_becomes_four_triangles_about_its_mean)
{
    const struct vec3 vertices[4] = {{0, 0, 0}, {1, 0, 0.01}, {1, 1, 0}, {0, 1, 0.01}};
    const int facets[1][4] = {{0, 1, 2, 3}};
    struct mesh mesh;
    mesh_build(&mesh, 4, vertices, 1, facets);
    EXPECT(mesh.n_vertices == 5 && mesh.n_edges == 8 && mesh.n_faces == 4);
    EXPECT(mesh.n_corners == 4);
    for (int k = 0; k < 4; k++)
        EXPECT(mesh.mean_of[0][k] == k);
    EXPECT_NEAR(mesh.place[4].x, 0.5, 1e-15);
    EXPECT_NEAR(mesh.place[4].z, 0.005, 1e-15);
    EXPECT(is_consistent(&mesh));
    mesh_clear(&mesh);
}

TEST(a_quad_that_is_not_convex_becomes_triangles)
{
    const struct vec3 vertices[4] = {{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}};
    const int facets[1][4] = {{0, 1, 2, 3}};
    struct mesh mesh;
    mesh_build(&mesh, 4, vertices, 1, facets);
    EXPECT(mesh.n_faces >= 3);
    for (int f = 0; f < mesh.n_faces; f++)
        EXPECT(mesh.faces[f].n == 3);
    EXPECT(is_consistent(&mesh));
    mesh_clear(&mesh);
}

TEST(facets_without_area_and_unused_vertices_are_left_out)
{
    const struct vec3 vertices[6] = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0},
                                     {0, 1, 0}, {2, 0, 0}, {0, 0, 0}};
    const int facets[4][4] = {
        {1, 2, 3, -1}, /* the only real one */
        {1, 2, 4, -1}, /* on a line */
        {1, 5, 2, -1}, /* two vertices in one place */
        {1, 2, 3, 5},  /* that triangle again, written as a quad */
    };
    struct mesh mesh;
    mesh_build(&mesh, 6, vertices, 4, facets);
    EXPECT(mesh.n_faces == 1 && mesh.n_vertices == 3);
    EXPECT(mesh.n_degenerate == 2 && mesh.first_degenerate == 1);
    EXPECT(mesh.n_duplicates == 1 && mesh.first_duplicate == 3);
    EXPECT(is_consistent(&mesh));
    mesh_clear(&mesh);
}

TEST(an_edge_with_three_faces_keeps_the_first_two)
{
    const struct vec3 vertices[5] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    const int facets[3][4] = {{0, 1, 2, -1}, {0, 1, 3, -1}, {0, 1, 4, -1}};
    struct mesh mesh;
    mesh_build(&mesh, 5, vertices, 3, facets);
    EXPECT(mesh.n_edges == 7);
    const struct mesh_edge *edge = &mesh.edges[mesh.faces[2].edges[0]];
    EXPECT(edge->faces[0] == 0 && edge->faces[1] == 1 && edge->n_faces == 3);
    EXPECT(is_consistent(&mesh));
    mesh_clear(&mesh);
}

TEST(a_survey_tells_a_closed_surface_from_one_with_a_hole)
{
    struct mesh mesh;
    mesh_build(&mesh, 8, CUBE, 6, CUBE_FACETS);
    struct mesh_survey survey = mesh_survey(&mesh);
    EXPECT(survey.closed && survey.n_open == 0 && survey.n_shared == 0 && survey.n_turned == 0);
    EXPECT_NEAR(survey.area, 6.0, 1e-15);
    EXPECT_NEAR(survey.volume, 1.0, 1e-15);
    EXPECT(survey.low.x == 0.0 && survey.high.z == 1.0);
    mesh_clear(&mesh);
    mesh_build(&mesh, 8, CUBE, 5, CUBE_FACETS);
    survey = mesh_survey(&mesh);
    EXPECT(!survey.closed && survey.n_open == 4 && survey.volume == 0.0);
    EXPECT(mesh.edges[survey.first_open].n_faces == 1);
    mesh_clear(&mesh);
}

TEST(a_survey_finds_facets_that_look_the_other_way_and_walls_that_meet_in_a_tee)
{
    const struct vec3 vertices[5] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
    const int facets[3][4] = {{0, 1, 2, -1}, {0, 1, 3, -1}, {0, 1, 4, -1}};
    struct mesh mesh;
    mesh_build(&mesh, 5, vertices, 3, facets);
    EXPECT(mesh_survey(&mesh).n_shared == 1 && !mesh_survey(&mesh).closed);
    mesh_clear(&mesh);
    mesh_build(&mesh, 5, vertices, 2, facets);
    EXPECT(mesh_survey(&mesh).n_turned == 1);
    EXPECT(mesh_survey(&mesh).first_turned == mesh.faces[0].edges[0]);
    mesh_clear(&mesh);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
