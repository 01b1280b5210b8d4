"""Water that flows down an open channel: scene, exact by Nusselt's film."""
