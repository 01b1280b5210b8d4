"""Toys that break one law each: laws of declarations, inputs and outputs."""

from dataclasses import replace

import numpy as np
from toy_planting import breaks
from toy_sound import CLOUD, CLOUD_LOAD, FLIGHT, Sound

from quintet.coupler.conform.laws import declarations, inputs, outputs
from quintet.interfaces import rotation
from quintet.interfaces.component import ONE_THREAD, Field, Port
from quintet.interfaces.ports import ANGULAR_VELOCITY, FORCE, LOAD, POSITION


@breaks(declarations.it_is_made_and_joined)
class FailsWhenJoined(Sound):
    def bind(self, static, joined):
        raise ArithmeticError("a defect")


@breaks(declarations.its_ports_are_those_of_its_manifest)
class PortsOfItsOwn(Sound):
    def __init__(self, params, resources=ONE_THREAD):
        super().__init__(params, resources)
        self.gives = (CLOUD_LOAD,)


@breaks(declarations.names_are_told_apart)
class PortGivenTwice(Sound):
    gives = (FLIGHT, CLOUD_LOAD, CLOUD_LOAD)


@breaks(declarations.names_are_told_apart)
class RateOfNoField(Sound):
    gives = (Port("flight", (POSITION, ANGULAR_VELOCITY)), CLOUD_LOAD)


@breaks(declarations.units_fit_each_other)
class WorkIsNoPower(Sound):
    takes = (
        Port("load", (FORCE, replace(FORCE, name="torque", works_with="angular_velocity"))),
        CLOUD,
    )


@breaks(declarations.units_fit_each_other)
class RateInAnotherUnit(Sound):
    takes = (
        LOAD,
        replace(CLOUD, fields=(POSITION, Field("velocity", (3,), "m"), *CLOUD.fields[2:])),
    )


@breaks(declarations.describe_tells_what_its_ports_announce)
class DescribeMissesAState(Sound):
    def describe(self):
        return {"flight.mass": super().describe()["flight.mass"]}


@breaks(declarations.describe_tells_what_its_ports_announce)
class DescribeTellsWhatNoPortAnnounces(Sound):
    def describe(self):
        return {**super().describe(), "flight.colour": np.zeros(2)}


@breaks(declarations.it_is_made_with_resources_or_without)
class OneThreadOnly(Sound):
    def __init__(self, params, resources=ONE_THREAD):
        assert resources.threads == 1
        super().__init__(params, resources)


@breaks(inputs.received_arrays_are_neither_written_to_nor_kept)
class KeepsWhatItTakes(Sound):
    def take(self, fields):
        super().take(fields)
        self.force = fields.get("load.force", self.force)


@breaks(inputs.received_arrays_are_neither_written_to_nor_kept)
class WritesIntoWhatItTakes(Sound):
    def take(self, fields):
        if "load.force" in fields:
            fields["load.force"][...] *= 0.5
        super().take(fields)


@breaks(inputs.received_arrays_are_neither_written_to_nor_kept)
class KeepsStaticFields(Sound):
    def bind(self, static, joined):
        super().bind(static, joined)
        self.volume = static.get("cloud.volume", self.volume)


@breaks(inputs.ports_may_be_left_unjoined)
class NeedsItsLoad(Sound):
    def take(self, fields):
        super().take(fields)
        self.force = np.array(fields["load.force"])


@breaks(inputs.ports_may_be_left_unjoined)
class MakesRoomForWhatIsNotThere(Sound):
    def bind(self, static, joined):
        super().bind(static, joined)
        if "cloud" not in joined:
            self.clock = np.zeros(1000)


@breaks(inputs.alone_it_runs_and_gives_nothing)
class NeedsAPartner(Sound):
    def step(self, dt):
        super().step(dt / len(self.volume))


@breaks(outputs.outputs_match_their_ports)
class WrongShape(Sound):
    def outputs(self):
        return {**super().outputs(), "flight.velocity": self.v[:, :2]}


@breaks(outputs.outputs_match_their_ports)
class SinglePrecision(Sound):
    def outputs(self):
        return {**super().outputs(), "flight.velocity": self.v.astype(np.float32)}


@breaks(outputs.just_what_is_wanted_is_given)
class GivesWhatIsNotWanted(Sound):
    def give(self, wanted):
        return super().give(frozenset(self.outputs()))


@breaks(outputs.just_what_is_wanted_is_given)
class MissesWhatIsWanted(Sound):
    def give(self, wanted):
        return super().give(wanted - {"cloud_load.force"})


@breaks(outputs.what_else_is_wanted_changes_no_bit)
class ImpulsesDependOnInstants(Sound):
    def outputs(self):
        return {**super().outputs(), "cloud_load.force": self.drag * self.scale}

    def give(self, wanted):
        self.scale = 1.0 if "flight.position" in wanted else 0.5
        return super().give(wanted)


@breaks(outputs.what_else_is_wanted_changes_no_bit)
class GiveChangesItsState(Sound):
    def give(self, wanted):
        self.v = self.v * (1.0 + 1e-15 * len(wanted))
        return super().give(wanted)


@breaks(outputs.the_number_of_items_never_changes)
class TheDeadAreLeftOut(Sound):
    def outputs(self):
        alive = self.active == 1.0
        fields = super().outputs()
        return {k: a[alive] if k.startswith("flight") else a for k, a in fields.items()}


@breaks(outputs.outputs_are_copies)
class OutputsAreViews(Sound):
    def give(self, wanted):
        fields = self.outputs()
        return {key: fields[key][:] for key in wanted}


@breaks(outputs.outputs_are_copies)
class DescribesItsOwnArrays(Sound):
    def __init__(self, params, resources=ONE_THREAD):
        super().__init__(params, resources)
        self.told = super().describe()

    def describe(self):
        return self.told


@breaks(outputs.at_rest_nothing_comes_out)
class DriftsAtRest(Sound):
    def step(self, dt):
        super().step(dt)
        self.x = self.x + 1e-6 * dt


@breaks(outputs.values_follow_their_rates)
class VelocityIsDoubled(Sound):
    def outputs(self):
        return {**super().outputs(), "flight.velocity": 2.0 * self.v}


@breaks(outputs.values_follow_their_rates)
class TurnsTheOtherWay(Sound):
    def outputs(self):
        fields = super().outputs()
        return {**fields, "flight.orientation": rotation.conjugate(fields["flight.orientation"])}


@breaks(outputs.rotations_are_unit_quaternions)
class RotationIsNotNormalised(Sound):
    def step(self, dt):
        zero = np.zeros((len(self.q), 1))
        turn = rotation.product(np.concatenate([zero, self.spin], axis=1), self.q)
        old_rotation = self.q
        super().step(dt)
        self.q = old_rotation + 0.5 * dt * turn
