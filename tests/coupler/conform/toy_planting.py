"""Components that are wrong on purpose, and the law that each of them breaks."""

PLANTED = {}  # class -> law


def breaks(law):
    """Plant a defect that breaks a law."""

    def plant(cls):
        PLANTED[cls] = law
        return cls

    return plant
