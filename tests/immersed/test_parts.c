/* Parts of the immersed model: the pressure and its roots, the Jacobian, the exact flows. */
#include "immersed_cases.h"

/* A sheared state in which nothing is zero and the laws are away from their kinks. */
static void disturb(struct model_state *s)
{
	double h;

	for (int a = 0; a < s->layers; a++) {
		s->now.phi[a] += 0.003 * sin(3 * a + 1);
		s->now.v[a] = 1e-2 * (a + 1) / s->layers * (1 + 0.1 * cos(a));
		s->now.u[a] = s->now.v[a] * (1 + 1e-3 * sin(a));
	}
	h = immersed_height(s, s->now.phi);
	assert_true(immersed_pressure_exact(s, &s->now, h) > 0);
}

/* X of P4 (45) over p for a layer: B + E/p. */
static void dilatation(const struct model_state *s, int a, double *B, double *E)
{
	const struct immersed_parameters *par = &s->par;
	double h = s->depth * s->l[a], slope = 1 / immersed_spacing(s, s->depth, a);
	double g = fabs(s->now.v[a] - (a ? s->now.v[a - 1] : 0)) * slope;

	*B = s->now.phi[a] * h * g * par->k * (s->now.phi[a] - par->phi_c);
	*E = s->now.phi[a] * h * g * g * par->k * par->k_2 * par->eta;
}

static double seepage(const struct model_state *s, int a)
{
	return s->depth * s->l[a] * immersed_seepage(&s->par, s->now.phi[a]);
}

static double weight(const struct model_state *s, int a)
{
	return s->par.weight * s->depth * s->l[a] * s->now.phi[a];
}

static void the_pressure_of_one_layer_is_the_positive_root_of_its_quadratic(void **state)
{
	static const double speeds[] = {1e-5, 1e-3, 1e-2, 1, 100};
	struct config config = case_config(low_loose, "layers=1;preserves=height");
	struct model_state *s = case_create(&config);

	(void)state;
	for (size_t i = 0; i < sizeof speeds / sizeof *speeds; i++) {
		double B, E, A = seepage(s, 0), half;

		s->now.v[0] = speeds[i];
		dilatation(s, 0, &B, &E);
		half = 0.5 * (weight(s, 0) + 0.5 * A * B);
		assert_true(immersed_pressure_exact(s, &s->now, s->depth) > 0);
		/* p^2 - 2 half p - A E/2 = 0, in the form that does not cancel where half is negative */
		assert_true(
			fabs(s->now.p[0] / (half > 0 ? half + sqrt(half * half + 0.5 * A * E)
										 : 0.5 * A * E / (sqrt(half * half + 0.5 * A * E) - half)) -
				 1) < 1e-12);
	}
	immersed_model.free(s);
}

/* Two layers: what is left of the lower equation when p of the lower interface is given. */
static double off(const struct model_state *s, double p, double *upper)
{
	double B[2], E[2], A = seepage(s, 1), X, half;

	dilatation(s, 0, &B[0], &E[0]);
	dilatation(s, 1, &B[1], &E[1]);
	X = B[0] + E[0] / p;
	half = 0.5 * (weight(s, 1) + A * (X + 0.5 * B[1]));
	*upper = half + sqrt(half * half + 0.5 * A * E[1]);
	return p - *upper - weight(s, 0) - 0.5 * seepage(s, 0) * X;
}

static void the_pressures_of_two_layers_are_those_found_by_bisection(void **state)
{
	static const double speeds[][2] = {{1e-5, 3e-5}, {1e-3, 1.5e-3}, {1e-2, 1.7e-2}, {1, 3}};
	struct config config = case_config(low_loose, "layers=2;preserves=height");
	struct model_state *s = case_create(&config);

	(void)state;
	for (size_t i = 0; i < sizeof speeds / sizeof *speeds; i++) {
		double low = 1e-6, high = 1e6, upper;

		s->now.v[0] = speeds[i][0];
		s->now.v[1] = speeds[i][1];
		for (int k = 0; k < 200; k++) {
			double middle = sqrt(low * high);

			*(off(s, middle, &upper) < 0 ? &low : &high) = middle;
		}
		assert_true(immersed_pressure_exact(s, &s->now, s->depth) > 0);
		assert_true(fabs(s->now.p[0] / low - 1) < 1e-10);
		assert_true(fabs(s->now.p[1] / upper - 1) < 1e-10);
	}
	immersed_model.free(s);
}

static void the_pressure_has_one_root_from_wherever_it_is_looked_for(void **state)
{
	struct config config = case_config(high_loose, "preserves=height");
	struct model_state *s = case_create(&config);
	double root[20];

	(void)state;
	disturb(s);
	memcpy(root, s->now.p, sizeof root);
	for (int start = 0; start < 20; start++) {
		for (int a = 0; a < s->layers; a++)
			s->now.p[a] = root[a] * pow(10, 3 * sin(7 * start + 5 * a));
		assert_true(immersed_pressure_exact(s, &s->now, s->depth) > 0);
		for (int a = 0; a < s->layers; a++)
			assert_true(fabs(s->now.p[a] / root[a] - 1) < 1e-10);
	}
	immersed_model.free(s);
}

/* Left out of the Jacobian on purpose: what the exchange between layers owes to S. */
static bool is_left_out(int row, int column)
{
	return (row == IMMERSED_V || row == IMMERSED_U) && column == IMMERSED_S;
}

static void shift(struct model_state *s, int a, int unknown, double by)
{
	double *const fields[] = {s->now.phi, s->now.v, s->now.u, s->now.p, s->now.S};

	fields[unknown][a] += by;
}

/* The Jacobian of the height-preserving model, where nothing else is left out, by central differences
 * of the residual. */
static void check_jacobian(const char *settings)
{
	enum { N = 4, B = IMMERSED_UNKNOWNS };
	struct config config = case_config(low_dense, settings);
	struct model_state *s = case_create(&config);
	const double steps[B] = {1e-6, 1e-7, 1e-7, 1e-4, 1e-10}, w = 1e-3;
	double unit_p, unit_S, plus[N * B], jacobian[3][N][B][B];

	disturb(s);
	immersed_units(s, &unit_p, &unit_S);
	immersed_assemble(s, &s->now, &s->now, w);
	memcpy(jacobian[0], s->blocks.below, sizeof jacobian[0]);
	memcpy(jacobian[1], s->blocks.diagonal, sizeof jacobian[1]);
	memcpy(jacobian[2], s->blocks.above, sizeof jacobian[2]);
	memcpy(s->known.phi, s->now.phi, sizeof(double) * N * B);
	for (int a = 0; a < N; a++)
		for (int j = 0; j < B; j++) {
			double unit = j == IMMERSED_P ? unit_p : j == IMMERSED_S ? unit_S : 1;

			shift(s, a, j, steps[j]);
			immersed_assemble(s, &s->now, &s->known, w);
			memcpy(plus, s->right, sizeof plus);
			shift(s, a, j, -2 * steps[j]);
			immersed_assemble(s, &s->now, &s->known, w);
			shift(s, a, j, steps[j]);
			for (int r = 0; r < N; r++)
				for (int i = 0; i < B && abs(r - a) <= 1; i++) {
					double here = (s->right[r * B + i] - plus[r * B + i]) / (2 * steps[j]) * unit;
					double there = jacobian[a - r + 1][r][i][j], row = 0;

					/* against the largest entry of the row, where differences lose digits */
					for (int k = 0; k < B; k++)
						row = fmax(row, fabs(jacobian[1][r][i][k]));
					if (!is_left_out(i, j) && fabs(here - there) > 1e-5 * row)
						fail_msg("%s: d row %d.%d/d %d.%d: %g by differences, %g", settings, r, i,
							a, j, here, there);
				}
		}
	immersed_model.free(s);
}

static void the_jacobian_is_that_of_the_residual(void **state)
{
	(void)state;
	check_jacobian("layers=4;preserves=height");
	check_jacobian("layers=4;preserves=height;dilatancy.interface_fraction=mean");
	check_jacobian("layers=4;preserves=height;rheology.law=mu_i");
	check_jacobian("layers=4;preserves=height;walls.mu_w=0.23;walls.width=15 mm");
	check_jacobian("layers=4;preserves=height;drag=off;bottom=friction");
	check_jacobian("layers=4;preserves=height;layer_fractions=[0.1, 0.4, 0.2, 0.3]");
}

static void exact_flows_between_walls_far_apart_are_those_without_walls(void **state)
{
	static const char *const laws[] = {"rheology.law=linear", "rheology.law=mu_i"};

	(void)state;
	for (size_t i = 0; i < 2; i++) {
		char settings[128];
		double v[2][20], phi[2][20];

		for (int k = 0; k < 2; k++) {
			(void)snprintf(settings, sizeof settings, "%s;walls.mu_w=%s;walls.width=1 km", laws[i],
				k ? "1e-3" : "0");
			struct config config = case_config(low_dense, settings);
			struct model_state *s = case_create(&config);

			immersed_exact(s, v[k], phi[k]);
			immersed_model.free(s);
		}
		for (int a = 0; a < 20; a++) {
			/* a wall of 1e-3 over 1 km takes some 1e-8 of the drive; the surface begins at 1e-9 m */
			assert_true(fabs(v[1][a] / v[0][a] - 1) < 2e-6);
			assert_true(fabs(phi[1][a] / phi[0][a] - 1) < 1e-6);
		}
	}
}

/* Where grains rest at the bottom the fraction is the critical one, and above it obeys the balance. */
static void exact_flows_in_a_narrow_channel_rest_at_the_bottom(void **state)
{
	struct config config =
		case_config(low_dense, "walls.mu_w=tan(13.1 deg);walls.width=5 mm;layers=50");
	struct model_state *s = case_create(&config);
	double v[50], phi[50];

	(void)state;
	immersed_exact(s, v, phi);
	assert_true(v[0] >= 0 && v[0] < 1e-9);
	assert_true(fabs(phi[0] - 0.582) < 1e-9);
	for (int a = 1; a < 50; a++)
		assert_true(v[a] >= v[a - 1] - 1e-12 && phi[a] <= phi[a - 1] + 1e-12);
	assert_true(v[49] > 1e-4);
	immersed_model.free(s);
}

static void below_the_angle_of_friction_the_exact_flow_rests(void **state)
{
	struct config config = case_config(low_dense, "slope=20 deg");
	struct model_state *s = case_create(&config);
	double v[20], phi[20];

	(void)state;
	immersed_exact(s, v, phi);
	for (int a = 0; a < 20; a++) {
		assert_true(v[a] == 0);
		assert_true(phi[a] == 0.582);
	}
	immersed_model.free(s);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_pressure_of_one_layer_is_the_positive_root_of_its_quadratic),
		cmocka_unit_test(the_pressures_of_two_layers_are_those_found_by_bisection),
		cmocka_unit_test(the_pressure_has_one_root_from_wherever_it_is_looked_for),
		cmocka_unit_test(the_jacobian_is_that_of_the_residual),
		cmocka_unit_test(exact_flows_between_walls_far_apart_are_those_without_walls),
		cmocka_unit_test(exact_flows_in_a_narrow_channel_rest_at_the_bottom),
		cmocka_unit_test(below_the_angle_of_friction_the_exact_flow_rests),
	};

	return cmocka_run_group_tests(tests, NULL, NULL);
}
