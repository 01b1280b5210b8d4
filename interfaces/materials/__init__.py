"""Materials by name: constants with their sources, which fill tables of a scene.

A parameter class whose table may name a material states in ``MATERIAL`` which constants it takes:

    @parameters
    class Gas:
        MATERIAL: ClassVar = {"gamma": "gamma", "gas_constant": "gas_constant"}
        material: MaterialName | None = None
        gamma: Positive = 1.4

A scene then has ``gas = "argon"``, or ``gas = { material = "argon", gamma = 1.67 }``: keys that
stand in the table go before those of the material.
"""
