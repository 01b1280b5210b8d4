"""Laws of a gas on a cloud, with the arguments that they are tried on."""

from printed_laws import Between, Law, vector

from quintet.components.meshless_gas.axis import laws as axis
from quintet.components.meshless_gas.clouds.cloud import INFLOW, OUTFLOW, SLIP
from quintet.components.meshless_gas.laws import (
    boundaries,
    far_field,
    fluxes,
    limiters,
    outflows,
    states,
    transport,
)
from quintet.components.meshless_gas.moving import laws as moving
from quintet.components.meshless_gas.viscous import laws as viscous
from quintet.components.meshless_gas.viscous.kernels import slip_laws as slip

ANY, PART, LARGE = Between(-1.0, 1.0), Between(0.01, 1.0), Between(0.5, 2.0)
AIR = transport.Transport(1.7e-5, 273.0, 110.0, 1400.0, 287.0)
GAMMA = 1.4
STATE = (LARGE, ANY, ANY, ANY, LARGE)
CHANGE = (ANY,) * 5
NORMAL, DIRECTION = (0.6, 0.0, 0.8), (LARGE, 0.6, 0.0, 0.8)
GIVEN = (*STATE, 0.0, 0.0, 0.0)
BEYOND = (*STATE, LARGE, 0.0, 0.0)
AT_REST = (*STATE, 0.0, Between(1.0, 3.0), LARGE)
TWO, SIX, VECTORS = (ANY,) * 2, (ANY,) * 6, (vector(1.0),) * 5
BETWEEN = (LARGE, ANY, LARGE)
WALL = (STATE, GIVEN, NORMAL, GAMMA)
THIN = AIR._replace(gas_constant=1.0 / 300.0)
SHARES = (Between(-9.0, -2.0), Between(3.0, 9.0), Between(-1.0, -0.1))  # 1/m, of a slope at a wall
ABOVE = (STATE, STATE, SHARES, vector(0.1), NORMAL)
LENGTHS = (LARGE, LARGE)

GAS_LAWS = [
    Law(fluxes.smoothness, (PART, PART, PART, PART, PART)),
    Law(fluxes.ausmpw, (PART, ANY, PART, PART, ANY, PART, PART, GAMMA)),
    Law(fluxes.wall_pressure, (PART, Between(-3.0, 3.0), GAMMA)),
    *(Law(law, (ANY, ANY, 0.1)) for law in limiters.LAWS.values()),
    *(
        Law(limiters.half_step, (limiters.limiter_of(name, None), ANY, ANY, 0.1), name=f" {name}")
        for name in limiters.LAWS
    ),
    Law(fluxes.half_steps, (limiters.limiter_of("koren", None), ANY, ANY, ANY, 0.1)),
    Law(fluxes.pair_direction, vector(1.0)),
    Law(fluxes.kept_share, (STATE, STATE, DIRECTION, PART, PART)),
    Law(fluxes.thresholds, (STATE, STATE, limiters.limiter_of("van_albada", 0.1))),
    Law(fluxes.positive_share, (PART, STATE, STATE, TWO, TWO)),
    Law(fluxes.sides, (ANY, ANY, PART, TWO)),
    Law(fluxes.pair_rates, (STATE, STATE, STATE, DIRECTION, PART, GAMMA)),
    Law(fluxes.in_laboratory, (CHANGE, ANY, ANY, ANY)),
    Law(far_field.velocity_change, (LARGE, LARGE, LARGE, GAMMA), ulp=6, cancels=True),
    Law(far_field.bracket, (*BETWEEN, *BETWEEN, GAMMA)),
    Law(far_field.between, (*BETWEEN, *BETWEEN, GAMMA), ulp=4, cancels=True),
    Law(far_field.at_rest, (*BETWEEN, LARGE, ANY, GAMMA), ulp=2, cancels=True),
    Law(far_field.with_normal_speed, (STATE, NORMAL, ANY, LARGE, ANY, LARGE)),
    Law(far_field.meet, (STATE, STATE, NORMAL, GAMMA), ulp=4, cancels=True),
    *(
        Law(
            boundaries.boundary_state, (kind, STATE, outer, NORMAL, vector(1.0), GAMMA, 1.0),
            ulp=10, cancels=True, name=name,
        )
        for name, kind, outer in (
            (" of inflow", INFLOW, GIVEN), (" from rest", INFLOW, AT_REST),
            (" of outflow", OUTFLOW, BEYOND), (" of a wall", SLIP, GIVEN),
        )
    ),
    Law(boundaries.come_in, WALL, ulp=4, cancels=True),
    Law(boundaries.from_rest, (STATE, AT_REST, GAMMA, 1.0), ulp=10, cancels=True),
    Law(boundaries.leave, (STATE, NORMAL, LARGE, GAMMA), ulp=2),
    Law(boundaries.slip, (STATE, NORMAL, vector(1.0), GAMMA), ulp=2),
    Law(boundaries.boundary_flow, (STATE, vector(1.0), GAMMA)),
    Law(boundaries.held_along, (STATE, STATE, NORMAL)),
    Law(outflows.outward_speed, (STATE, NORMAL)),
    Law(outflows.let_waves_out, (ANY, LARGE, LARGE, NORMAL, CHANGE)),
    Law(outflows.roughness, (PART, 7, 0.5, 1.0)),
    Law(outflows.held_near, (LARGE, LARGE, LARGE, ANY, PART)),
    Law(outflows.continued, (STATE, ANY, LARGE, NORMAL, CHANGE, STATE, STATE, PART)),
    Law(states.sound_speed, (LARGE, LARGE, GAMMA)),
    Law(states.staged, (ANY,) * 6),
    Law(states.primitive_state, (LARGE, ANY, ANY, ANY, LARGE, GAMMA)),
    Law(states.is_state, (ANY, ANY)),
    Law(states.change_square, (ANY, PART, LARGE)),
    Law(states.crossing_rate, (vector(1.0), vector(1.0), vector(1.0), LARGE, LARGE)),
    Law(transport.sutherland, (Between(100.0, 2000.0), AIR)),
    Law(viscous.gas_temperature, (LARGE, LARGE, 287.0)),
    Law(viscous.stress, (vector(1.0), vector(1.0), vector(1.0), PART)),
    Law(viscous.corrected, (vector(1.0), vector(1.0), ANY, vector(1.0), LARGE)),
    Law(viscous.along, (SIX, ANY, ANY, ANY)),
    Law(
        viscous.pair_transfer,
        (
            vector(1.0), vector(1.0), VECTORS, VECTORS, vector(1.0), vector(1.0), ANY, vector(1.0),
            LARGE, vector(1.0), PART, AIR,
        ),
    ),
    Law(viscous.own_transfer, (vector(1.0), VECTORS, vector(1.0), vector(1.0), PART, AIR)),
    Law(viscous.diffusion_rate, (PART, LARGE, PART, GAMMA, AIR)),
    Law(viscous.wall_state, (LARGE, LARGE, LARGE, vector(1.0), LARGE, GAMMA, AIR)),
    Law(viscous.wall_traction, (STATE, STATE, STATE, PART, LARGE, vector(1.0), NORMAL, AIR)),
    Law(viscous.wall_slope, (ANY, ANY, ANY, PART, LARGE)),
    Law(viscous.slip_length, (PART,)),
    Law(viscous.jump_length, (PART, GAMMA, PART)),
    Law(viscous.slope_shares, (PART, LARGE)),
    Law(viscous.mean_free_path, (PART, LARGE, LARGE, 287.0)),
    Law(slip.extrapolated_slip, (SHARES, STATE, STATE, vector(0.1), NORMAL)),
    *(
        Law(slip.temperature_at_wall, (LARGE, *ABOVE, warmth, LENGTHS, PART, THIN), name=name)
        for name, warmth in (("", Between(200.0, 400.0)), (" that is adiabatic", -1.0))
    ),
    Law(slip.velocity_at_wall, (STATE, *ABOVE, vector(9.0), LARGE, PART, THIN)),
    Law(slip.spread, (vector(1.0), vector(1.0), NORMAL)),
    Law(slip.slip_traction, (STATE, *ABOVE, ANY, PART, THIN)),
    Law(moving.slip_wall_state, (STATE, STATE, PART, LARGE, NORMAL, vector(1.0), GAMMA), ulp=2),
    Law(moving.level_temperature, (LARGE, LARGE, PART, Between(1.1, 2.0))),
    Law(axis.axis_rates, (LARGE, ANY, ANY, LARGE, PART, GAMMA)),
    Law(axis.swelling_stress, (ANY, PART, PART)),
    Law(axis.axis_stresses, (*(ANY,) * 5, PART, PART, ANY, TWO, TWO, ANY)),
]  # fmt: skip
